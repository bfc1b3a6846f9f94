// SPDX-License-Identifier: Apache-2.0
// Durations as bars, an octave each, heights on a logarithmic scale: one late step in a million shall be seen.
import type { Durations } from "../gen/phalanx/cockpit_pb";
import { strings } from "../strings";
import { el, setAttribute, setText } from "./dom";

const kFirstUs = 0.1;
const kSvg = "http://www.w3.org/2000/svg";
const kBar = 9;
const kHeight = 48;

/// 0.8 µs, 25.6 µs, 1.6 ms, 3.3 s.
export function duration(microseconds: number): string {
  const digits = (value: number) => value.toLocaleString(strings.figures, { maximumSignificantDigits: 3, useGrouping: false });
  const units = strings.device.durations;
  if (!Number.isFinite(microseconds)) return strings.dash;
  // Less than a nanosecond is the rounding of the clock, and its digits are wider than the panel.
  if (microseconds < 1000) return units.us(digits(Math.round(microseconds * 1000) / 1000));
  if (microseconds < 1e6) return units.ms(digits(microseconds / 1000));
  return units.s(digits(microseconds / 1e6));
}

/// Heights 0 .. 1; none of them empty where something was counted.
export function barHeights(counts: readonly bigint[]): number[] {
  const logs = counts.map((count) => (count > 0n ? 1 + Math.log10(Number(count)) : 0));
  const highest = Math.max(1, ...logs);
  return logs.map((value) => value / highest);
}

/// First and last octave that something fell into; null: none.
export function usedOctaves(counts: readonly bigint[]): readonly [number, number] | null {
  const first = counts.findIndex((count) => count > 0n);
  if (first < 0) return null;
  let last = counts.length - 1;
  while (counts[last] === 0n) --last;
  return [first, last];
}

export interface Histogram {
  readonly element: HTMLElement;
  show(durations: Durations | undefined): void;
}

export function histogram(title: string): Histogram {
  const words = strings.device;
  const svg = document.createElementNS(kSvg, "svg");
  svg.setAttribute("class", "histogram");
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", title);
  svg.setAttribute("preserveAspectRatio", "none");
  const from = el("span");
  const to = el("span");
  const names = [words.median, words.p99, words.p999, words.longest];
  const values = names.map(() => el("dd"));
  const list = el("dl", { class: "percentiles" });
  names.forEach((name, i) => list.append(el("div", {}, el("dt", {}, name), values[i] ?? "")));
  const element = el("div", { class: "durations" }, el("h3", {}, title), list, svg as unknown as HTMLElement, el("div", { class: "slider-ends", "aria-hidden": "true" }, from, to));

  const show = (durations: Durations | undefined) => {
    const numbers = [durations?.p50Us, durations?.p99Us, durations?.p999Us, durations?.maxUs];
    values.forEach((value, i) => setText(value, duration(numbers[i] ?? NaN)));
    const counts = durations?.octave ?? [];
    const used = usedOctaves(counts);
    if (!used) {
      svg.replaceChildren();
      setAttribute(svg, "aria-label", title);
      setText(from, "");
      setText(to, "");
      return;
    }
    const [first, last] = used;
    const heights = barHeights(counts.slice(first, last + 1));
    setAttribute(svg, "viewBox", `0 0 ${heights.length * kBar} ${kHeight}`);
    const begin = duration(kFirstUs * 2 ** first);
    const end = duration(kFirstUs * 2 ** (last + 1));
    setAttribute(svg, "aria-label", words.histogram(title, begin, end));
    while (svg.childElementCount > heights.length) svg.lastElementChild?.remove();
    while (svg.childElementCount < heights.length) svg.append(document.createElementNS(kSvg, "rect"));
    heights.forEach((height, i) => {
      const bar = svg.children[i];
      if (!bar) return;
      setAttribute(bar, "x", String(i * kBar + 1));
      setAttribute(bar, "width", String(kBar - 2));
      setAttribute(bar, "y", String(kHeight * (1 - height)));
      setAttribute(bar, "height", String(kHeight * height));
    });
    setText(from, begin);
    setText(to, end);
  };
  return { element, show };
}
