// SPDX-License-Identifier: Apache-2.0
// Play, pause, step, speed, and the displayed moment as time.
import { clockTime, durationText } from "../panels/as_text";
import { button, el, setAttribute, setText } from "../panels/dom";
import { strings } from "../strings";
import { speeds, type Playhead } from "./playhead";

const words = strings.replay;

export interface TransportActions {
  toggle(): void;
  pose(direction: 1 | -1): void;
  event(direction: 1 | -1): void;
}

export interface Transport {
  readonly element: HTMLElement;
  update(): void;
}

/// @param begin  of the recording, UTC [s]
export function transport(playhead: Playhead, begin: number, actions: TransportActions): Transport {
  const play = button(words.play, actions.toggle, { class: "primary play", "aria-keyshortcuts": "Space" });
  const step = (text: string, long: string, act: () => void) => button(text, act, { "aria-label": long, title: long });
  const rates = speeds.map((speed) => button(words.times(String(speed)), () => playhead.setSpeed(speed), { "aria-pressed": "false" }));
  const at = el("strong", { class: "time-at" });
  const clock = el("span", { class: "hint" });
  const length = durationText(playhead.length);
  return {
    element: el(
      "div",
      { class: "transport" },
      el(
        "div",
        { class: "buttons" },
        step(words.eventBack, words.eventBackLong, () => actions.event(-1)),
        step(words.poseBack, words.poseBackLong, () => actions.pose(-1)),
        play,
        step(words.poseOn, words.poseOnLong, () => actions.pose(1)),
        step(words.eventOn, words.eventOnLong, () => actions.event(1)),
      ),
      el("p", { class: "time" }, at, el("span", {}, ` / ${length}`), clock),
      el("div", { class: "segmented speeds", role: "group", "aria-label": words.speed }, ...rates),
    ),
    update() {
      setText(play, playhead.playing ? words.pause : words.play);
      setText(at, durationText(playhead.position));
      setText(clock, words.clock(clockTime(begin + playhead.position)));
      rates.forEach((one, i) => setAttribute(one, "aria-pressed", String(speeds[i] === playhead.speed)));
    },
  };
}
