// SPDX-License-Identifier: Apache-2.0
// One plot over the last seconds, drawn by uPlot from the history's own storage.
import uPlot from "uplot";
import type { History } from "../state/history";
import { kHistorySeconds } from "../state/store";
import { strings } from "../strings";
import { themes, type ThemeName } from "../theme";
import { el } from "../panels/dom";
import { curvesOf, type Curve, type PlotKind } from "./plot_kinds";

const kGapSeconds = 0.25; // a longer pause between two samples is a gap in the curve
const kHoverCurves = 8;
const kLineEnd = 4; // how far a line reaches beyond its first point [px]
const kSmallest: Readonly<Record<PlotKind, number>> = { force: 1, torque: 0.02, angle: 10 }; // span of the axis at least

export interface Chart {
  readonly element: HTMLElement;
  readonly canvas: () => HTMLCanvasElement;
  setDigits(digits: readonly boolean[]): void;
  setTheme(theme: ThemeName): void;
  draw(): void;
  resize(): void;
  dispose(): void;
}

/// Stretches in which a force is zero: not drawn, so that 15 lines do not lie on the axis.
function idleOf(values: ArrayLike<number | null | undefined>, toPixel: (index: number) => number): [number, number][] {
  const idle: [number, number][] = [];
  for (let i = 0; i < values.length; ++i) {
    if (values[i] !== 0) continue;
    const from = i;
    while (i + 1 < values.length && values[i + 1] === 0) ++i;
    if (i > from) idle.push([toPixel(from) - (from === 0 ? kLineEnd : 0), toPixel(i)]);
  }
  return idle;
}

/// Pauses in the times as uPlot wants its gaps: pixels from, to.
function gapsOf(time: ArrayLike<number>, toPixel: (time: number) => number): [number, number][] {
  const gaps: [number, number][] = [];
  for (let i = 1; i < time.length; ++i) {
    if (time[i]! - time[i - 1]! > kGapSeconds) gaps.push([toPixel(time[i - 1]!), toPixel(time[i]!)]);
  }
  return gaps;
}

/// The axis: from zero or below to a little above, never narrower than what is worth looking at.
/// No digit is sent more; what the law asks of a stiff wall may be many times that, and would flatten the curves that are felt [N].
const kMostForceShown = 10;

export function valueRange(kind: PlotKind, low: number | null, high: number | null): [number, number] {
  const least = kSmallest[kind];
  const both = kind === "torque"; // pushes both ways
  const min = Math.min(both ? -least / 2 : 0, low ?? 0);
  const highest = kind === "force" ? Math.min(high ?? 0, kMostForceShown) : (high ?? 0);
  const max = Math.max(both ? least / 2 : least, highest);
  const room = 0.08 * (max - min);
  return [min < 0 ? min - room : 0, max + room];
}

export function chart(kind: PlotKind, history: History, theme: ThemeName, digits: readonly boolean[]): Chart {
  let curves: readonly Curve[] = curvesOf(kind, digits);
  let colours = themes[theme];
  let plot: uPlot | null = null;
  const scratch = new Map<number, Float32Array>();
  const tip = el("div", { class: "plot-tip", hidden: true });
  const host = el("div", { class: "plot-host" });
  const element = el("div", { class: "plot" }, host, tip);

  /// Values for people; only angles differ from what is kept.
  function values(curve: Curve): Float32Array {
    const kept = history.channel(curve.channel.index);
    if (curve.scale === 1) return kept;
    let room = scratch.get(curve.channel.index);
    if (!room || room.length !== history.capacity) scratch.set(curve.channel.index, (room = new Float32Array(history.capacity)));
    for (let i = 0; i < kept.length; ++i) room[i] = kept[i]! * curve.scale;
    return room.subarray(0, kept.length);
  }
  const data = () => [history.time(), ...curves.map(values)] as unknown as uPlot.AlignedData;

  function series(curve: Curve): uPlot.Series {
    return {
      label: curve.label,
      stroke: curve.colour,
      width: curve.width,
      dash: [...curve.dash],
      points: { show: false },
      gaps: (u, index) => {
        const toPixel = (time: number) => u.valToPos(time, "x", true);
        const pauses = gapsOf(u.data[0], toPixel);
        const idle = kind === "force" ? idleOf(u.data[index] ?? [], (i) => toPixel(u.data[0][i] ?? 0)) : [];
        return [...pauses, ...idle].sort((a, b) => a[0] - b[0]) as uPlot.Series.Gaps;
      },
    };
  }

  function hover(u: uPlot): void {
    const at = u.cursor.idx;
    const time = at === null || at === undefined ? undefined : u.data[0][at];
    if (at === null || at === undefined || time === undefined || (u.cursor.left ?? -1) < 0) {
      tip.hidden = true;
      return;
    }
    const found = curves
      .map((curve, i) => ({ curve, value: Number(u.data[i + 1]?.[at]) }))
      .filter(({ value }) => Number.isFinite(value) && value !== 0)
      .sort((a, b) => Math.abs(b.value) - Math.abs(a.value));
    const unit = strings.plots.units[kind];
    const lines = found.slice(0, kHoverCurves).map(({ curve, value }) => {
      const swatch = el("span", { class: "swatch", "data-digit": curve.channel.digit });
      return el("div", {}, swatch, curve.label, el("b", {}, `${value.toFixed(kind === "angle" ? 0 : kind === "force" ? 2 : 3)} ${unit}`));
    });
    const more = found.length - lines.length;
    tip.replaceChildren(
      el("small", {}, strings.plots.ago((time - history.end).toFixed(2))),
      ...(lines.length > 0 ? lines : [el("div", {}, strings.plots.nothing)]),
      ...(more > 0 ? [el("small", {}, strings.plots.more(more))] : []),
    );
    tip.hidden = false;
    const left = u.cursor.left ?? 0;
    const right = left < u.over.clientWidth / 2;
    tip.style.left = right ? `${left + u.over.offsetLeft + 14}px` : "auto";
    tip.style.right = right ? "auto" : `${u.over.clientWidth - left + 14}px`;
  }

  function axis(): uPlot.Axis {
    const size = getComputedStyle(document.documentElement).fontSize;
    return {
      stroke: colours.quiet,
      grid: { stroke: colours.grid, width: 1 },
      ticks: { show: false },
      font: `calc(${size} * 0.75) system-ui, sans-serif`.replace(/calc\((.+)px \* 0.75\)/, (_, px: string) => `${0.75 * Number(px)}px`),
    };
  }

  function build(): void {
    plot?.destroy();
    const { clientWidth: width, clientHeight: height } = host;
    const options: uPlot.Options = {
      width: Math.max(width, 80),
      height: Math.max(height, 60),
      legend: { show: false },
      cursor: { drag: { x: false, y: false, setScale: false }, points: { show: false } },
      scales: {
        x: { time: false, range: () => [history.end - kHistorySeconds, history.end] },
        y: { range: (_, low, high) => valueRange(kind, low, high) },
      },
      axes: [
        { ...axis(), size: 28, space: 60, values: (_, at) => at.map((time) => strings.plots.ago((time - history.end).toFixed(0))), splits: () => seconds() },
        { ...axis(), size: 46, space: 26 },
      ],
      series: [{}, ...curves.map(series)],
      hooks: { setCursor: [hover] },
    };
    plot = new uPlot(options, data(), host);
  }
  /// Whole seconds back from now, so that the figures stand still while the curves pass.
  const seconds = () => [10, 8, 6, 4, 2, 0].map((ago) => history.end - ago);

  build();
  return {
    element,
    canvas: () => plot!.ctx.canvas,
    setDigits(next) {
      curves = curvesOf(kind, next);
      build();
    },
    setTheme(next) {
      colours = themes[next];
      build();
    },
    draw() {
      if (history.length > 0) plot?.setData(data(), true);
    },
    resize() {
      const { clientWidth: width, clientHeight: height } = host;
      if (width > 0 && height > 0) plot?.setSize({ width, height });
    },
    dispose() {
      plot?.destroy();
      plot = null;
    },
  };
}
