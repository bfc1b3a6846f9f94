// SPDX-License-Identifier: Apache-2.0
// Over the view: why the hand cannot be seen, or is not that of the displayed moment.
import { button, el, setShown, setText } from "../panels/dom";
import { isMeasured } from "../state/channels";
import { strings } from "../strings";
import { kLongRead, type Player } from "./player";
import { troubleText } from "./trouble";

const words = strings.replay;

export interface Note {
  readonly element: HTMLElement;
  update(now: number): void; // [ms]
}

export function note(player: Player): Note {
  const text = el("p", { role: "status" });
  const alarm = el("p", { role: "alert" });
  const retry = button(words.retry, () => player.retry());
  const element = el("div", { class: "replay-note", hidden: true }, text, alarm, retry);
  let readingSince: number | undefined;
  function what(now: number): string {
    readingSince = player.loading ? (readingSince ?? now) : undefined;
    if (player.trouble !== undefined) return "";
    if (readingSince !== undefined && now - readingSince > kLongRead) return words.reading;
    if (player.hole) return words.hole;
    if (player.tick && !isMeasured(player.tick)) return words.unmeasured;
    if (player.recording.count("/geometry") === 0) return words.noGeometry;
    return player.shapesTrouble ? words.badShapes : "";
  }
  return {
    element,
    update(now) {
      setText(text, what(now));
      setText(alarm, player.trouble === undefined ? "" : `${words.cut} ${troubleText(player.trouble, player.recording.source.name)}`);
      setShown(retry, player.trouble !== undefined);
      setShown(element, text.textContent !== "" || alarm.textContent !== "");
    },
  };
}
