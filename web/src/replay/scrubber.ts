// SPDX-License-Identifier: Apache-2.0
// The whole length of a recording: the force on each digit, events, and the displayed moment, which is moved by pointer or keys.
import { el, setAttribute, setShown, setText } from "../panels/dom";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import { happeningText, type Happening } from "./event_list";
import type { Overview } from "./overview";
import { drawStrip } from "./strip";
import { durationText } from "../panels/as_text";

const words = strings.replay;
const kArrowStep = 1; // [s] for ArrowUp and ArrowDown; the page's keys do the others
const kNear = 6; // a pointer so near to an event is on it [px]

export interface Scrubber {
  readonly element: HTMLElement;
  show(happenings: readonly Happening[]): void; // the overview has grown
  update(position: number): void;
  setTheme(theme: ThemeName): void;
}

export function scrubber(overview: Overview, seconds: number, theme: ThemeName, seek: (time: number) => void): Scrubber {
  let colours = theme;
  let happenings: readonly Happening[] = [];
  const canvas = el("canvas", { class: "strip", "aria-hidden": "true" });
  const head = el("span", { class: "playhead", "aria-hidden": "true" });
  const tip = el("div", { class: "strip-tip", hidden: true, "aria-hidden": "true" });
  const track = el(
    "div",
    {
      class: "track", role: "slider", tabindex: 0, "aria-label": words.position,
      "aria-valuemin": 0, "aria-valuemax": seconds.toFixed(1), "aria-orientation": "horizontal",
    },
    canvas,
    head,
    tip,
  );
  const scale = el("span", { class: "lane-scale" });
  const digits = strings.digits.map((name, digit) => el("span", { "data-digit": digit }, name));
  const names = el("div", { class: "lane-names", "aria-hidden": "true", title: words.laneHint }, scale, ...digits);
  const progress = el("p", { class: "hint strip-progress" });

  const timeAt = (x: number) => {
    const box = track.getBoundingClientRect();
    return box.width > 0 ? Math.min(seconds, Math.max(0, ((x - box.left) / box.width) * seconds)) : 0;
  };
  const near = (time: number) => {
    const reach = (kNear / Math.max(1, track.clientWidth)) * seconds;
    return happenings.filter((one) => Math.abs(one.time - time) <= reach).sort((a, b) => Math.abs(a.time - time) - Math.abs(b.time - time))[0];
  };
  const forceLine = (force: number, digit: number) =>
    el("div", {}, el("span", { class: "swatch", "data-digit": digit }), words.forceOf(strings.digits[digit] ?? "", force.toFixed(1)));
  function hover(event: PointerEvent): void {
    const time = timeAt(event.clientX);
    const forces = overview.forcesAt(time);
    const inHole = overview.holes.find(({ begin, end }) => time >= begin && time <= end);
    const on = near(time) ?? (inHole && happenings.find((one) => one.kind === "gap" && one.time === inHole.begin));
    tip.replaceChildren(
      el("b", {}, durationText(time)),
      ...(on ? [el("div", {}, strings.plots.event(on.label, happeningText(on)))] : []),
      ...(forces
        ? forces.map(forceLine)
        : [el("div", {}, words.unknownForce)]),
    );
    setShown(tip, true);
    const share = seconds > 0 ? time / seconds : 0;
    tip.style.left = share < 0.5 ? `${100 * share}%` : "auto";
    tip.style.right = share < 0.5 ? "auto" : `${100 * (1 - share)}%`;
  }
  let displayed = 0; // moment
  track.addEventListener("keydown", (event) => {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (direction === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    seek(displayed + direction * kArrowStep);
    event.preventDefault();
  });
  let dragging = false;
  track.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    dragging = true;
    track.setPointerCapture(event.pointerId);
    const on = near(timeAt(event.clientX));
    seek(on ? on.time : timeAt(event.clientX));
  });
  track.addEventListener("pointermove", (event) => {
    hover(event);
    if (dragging) seek(timeAt(event.clientX));
  });
  for (const end of ["pointerup", "pointercancel"] as const) track.addEventListener(end, () => (dragging = false));
  track.addEventListener("pointerleave", () => setShown(tip, false));

  function draw(): void {
    drawStrip(canvas, { overview, happenings, seconds }, colours);
  }
  new ResizeObserver(draw).observe(track);
  return {
    element: el("div", { class: "scrubber" }, names, track, progress),
    show(next) {
      happenings = next;
      setText(scale, words.lanes(overview.largest.toFixed(1)));
      setText(progress, overview.progress < 1 ? words.overview((100 * overview.progress).toFixed(0)) : "");
      draw();
    },
    update(position) {
      displayed = position;
      head.style.left = `${seconds > 0 ? (100 * position) / seconds : 0}%`;
      setAttribute(track, "aria-valuenow", position.toFixed(1));
      setAttribute(track, "aria-valuetext", words.positionText(durationText(position), durationText(seconds)));
    },
    setTheme(next) {
      colours = next;
      draw();
    },
  };
}
