// SPDX-License-Identifier: Apache-2.0
// The chart of one trend: its values over time, and around the first one the smallest real difference that is published for the measure. A
// value outside of that band is a change that the measure's own scatter does not explain.
import { el, svg, svgText } from "../panels/dom";
import type { Exercise, Trend } from "./shapes";
import { axisDay, changeText, dayText, figureText, trendTitle, valueText, verdictText, words } from "./words";

const kWidth = 320;
const kHeight = 176;
const kLeft = 46;
const kRight = 14;
const kTop = 12;
const kBottom = 26;
const kMargin = 0.08; // of the values' extent, above and below
const kTicks = 2; // at least; nice steps make up to five
const kManyPoints = 30;
const kDay = 86_400; // [s]

/// Steps of 1, 2 or 5 times a power of ten. @param least  so many of them fit into the extent, at least
export function niceTicks(low: number, high: number, least: number): readonly number[] {
  const extent = high - low;
  if (!(extent > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(extent / least));
  const step = [5, 2, 1].map((factor) => factor * power).find((one) => extent / one >= least) ?? power;
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

/// Extent of what the chart has to show.
function extent({ points, first, smallest }: Trend): readonly [number, number] {
  const values = points.map(({ value }) => value);
  if (smallest !== undefined) values.push(first - smallest, first + smallest);
  const low = Math.min(...values);
  const high = Math.max(...values);
  const room = high > low ? kMargin * (high - low) : Math.max(1e-6, 0.1 * Math.abs(low) || 1);
  return [low - room, high + room];
}

/// Times that have a label: the first and the last one, and the middle where there is a place for it.
function labelled(begin: number, end: number): readonly number[] {
  if (end - begin < kDay) return [begin];
  return end - begin < 2 * kDay ? [begin, end] : [begin, (begin + end) / 2, end];
}

/// In one sentence what the chart shows, for those who cannot see it.
function sentence(trend: Trend, exercises: readonly Exercise[]): string {
  const { points, unit } = trend;
  const said = (at: number) => words.trends.on(valueText(points[at]!.value, unit), dayText(points[at]!.date));
  return `${trendTitle(trend, exercises)}: ${words.trends.from(said(0), said(points.length - 1))}. ${verdictText(trend)}`;
}

/// @param exercises  that there are: a trend is named by the title of its exercise
export function trendFigure(trend: Trend, exercises: readonly Exercise[]): HTMLElement {
  const { points, unit, smallest, first } = trend;
  const [low, high] = extent(trend);
  const begin = points[0]!.date;
  const end = points.at(-1)!.date;
  const x = (date: number) => (end > begin ? kLeft + ((date - begin) / (end - begin)) * (kWidth - kLeft - kRight) : (kLeft + kWidth - kRight) / 2);
  const y = (value: number) => kHeight - kBottom - ((value - low) / (high - low)) * (kHeight - kTop - kBottom);
  const right = kWidth - kRight;
  const chart = svg("svg", { class: "trend-chart", viewBox: `0 0 ${kWidth} ${kHeight}`, role: "img", "aria-label": sentence(trend, exercises) });

  if (smallest !== undefined) {
    const top = y(first + smallest);
    chart.append(svg("rect", { class: "trend-band", x: kLeft, y: top, width: right - kLeft, height: y(first - smallest) - top }));
  }
  for (const tick of niceTicks(low, high, kTicks)) {
    chart.append(svg("line", { class: "trend-grid", x1: kLeft, x2: right, y1: y(tick), y2: y(tick) }));
    chart.append(svgText(figureText(tick), { class: "trend-figure", x: kLeft - 6, y: y(tick) + 4, "text-anchor": "end" }));
  }
  if (smallest !== undefined) chart.append(svg("line", { class: "trend-first", x1: kLeft, x2: right, y1: y(first), y2: y(first) }));
  const times = labelled(begin, end);
  times.forEach((time, i) => {
    const anchor = times.length === 1 ? "middle" : i === 0 ? "start" : i === times.length - 1 ? "end" : "middle";
    chart.append(svgText(axisDay(time), { class: "trend-figure", x: x(time), y: kHeight - 8, "text-anchor": anchor }));
  });
  chart.append(svg("polyline", { class: "trend-line", points: points.map(({ date, value }) => `${x(date).toFixed(1)},${y(value).toFixed(1)}`).join(" ") }));
  for (const { date, value } of points) {
    const dot = svg("circle", { class: "trend-dot", cx: x(date).toFixed(1), cy: y(value).toFixed(1), r: points.length > kManyPoints ? 2 : 4 });
    const title = svg("title", {});
    title.textContent = `${dayText(date)}: ${valueText(value, unit)}`;
    dot.append(title);
    chart.append(dot);
  }

  const change = points.length > 1 ? changeText(trend.last - first, unit) : "";
  const band = smallest === undefined ? words.trends.noBand : words.trends.band(valueText(smallest, unit));
  return el(
    "figure",
    { class: "trend", "data-proven": String(trend.proven) },
    el("figcaption", {}, el("strong", {}, trendTitle(trend, exercises)), unit === "" || unit === "-" ? null : el("small", {}, ` ${unit}`)),
    chart,
    el("p", { class: "trend-verdict" }, change === "" ? verdictText(trend) : words.trends.judged(verdictText(trend), change)),
    el("small", {}, band),
  );
}
