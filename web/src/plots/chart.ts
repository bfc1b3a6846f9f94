// SPDX-License-Identifier: Apache-2.0
// One plot over the last seconds, drawn by uPlot from the history's own storage.
import uPlot from "uplot";
import type { History } from "../state/history";
import { kHistorySeconds } from "../state/store";
import { strings } from "../strings";
import { themes, type ThemeName } from "../theme";
import { el, setText } from "../panels/dom";
import { drawCutOff } from "./cut_off";
import { curvesOf, type Curve, type PlotKind } from "./plot_kinds";
import { readings, spokenReadings, tipLines, type Reading } from "./readings";
import { valueRange } from "./value_range";

const kGapSeconds = 0.25; // a longer pause between two samples is a gap in the curve
const kLineEnd = 4; // how far a line reaches beyond its first point [px]
/// How far an arrow key goes, as a share of the plot: to the right, and down. Home and End go to the oldest and the newest values.
const kSteps: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-0.01, 0],
  ArrowRight: [0.01, 0],
  ArrowUp: [0, -0.05],
  ArrowDown: [0, 0.05],
  Home: [-1, 0],
  End: [1, 0],
};
const kNowhere = { left: -10, top: -10 }; // uPlot's word for no cursor

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

export function chart(kind: PlotKind, history: History, theme: ThemeName, digits: readonly boolean[]): Chart {
  let chosen = digits;
  let name = theme;
  let curves: readonly Curve[] = [];
  let colours = themes[theme];
  let plot: uPlot | null = null;
  const scratch = new Map<number, Float32Array>();
  const tip = el("div", { class: "plot-tip", hidden: true });
  const host = el("div", { class: "plot-host" });
  const spoken = el("span", { class: "visually-hidden", role: "status" });
  const label = `${strings.plots.titles[kind]}. ${strings.plots.keys}`;
  const element = el("div", { class: "plot", tabindex: 0, role: "application", "aria-label": label }, host, tip, spoken);

  /// Values as displayed; only angles differ from the stored ones.
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

  /// The values at the cursor; null: there is no cursor.
  function pointedAt(u: uPlot): { readonly ago: number; readonly found: readonly Reading[] } | null {
    const { idx: at, left = -1, top = 0 } = u.cursor;
    const time = at === null || at === undefined ? undefined : u.data[0][at];
    if (at === null || at === undefined || time === undefined || left < 0) return null;
    const here = curves.map((_, i) => Number(u.data[i + 1]?.[at]));
    return { ago: time - history.end, found: readings(kind, curves, here, (value) => Math.abs(u.valToPos(value, "y") - top)) };
  }

  function hover(u: uPlot): void {
    const what = pointedAt(u);
    tip.hidden = what === null;
    if (!what) return;
    tip.replaceChildren(...tipLines(kind, what.ago, what.found));
    const left = u.cursor.left ?? 0;
    const right = left < u.over.clientWidth / 2;
    tip.style.left = right ? `${left + u.over.offsetLeft + 14}px` : "auto";
    tip.style.right = right ? "auto" : `${u.over.clientWidth - left + 14}px`;
  }

  /// The cursor by keys, which also say aloud what it finds; they begin at the newest values.
  function key(event: KeyboardEvent): void {
    const step = kSteps[event.key];
    if (!step || !plot || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault(); // the page's scrolling
    const width = plot.bbox.width / uPlot.pxRatio;
    const height = plot.bbox.height / uPlot.pxRatio;
    const { left = -1, top = -1 } = plot.cursor;
    const [fromLeft, fromTop] = left < 0 ? [width, height / 2] : [left, top];
    const inside = (value: number, most: number) => Math.min(most, Math.max(0, value));
    plot.setCursor({ left: inside(fromLeft + step[0] * width, width), top: inside(fromTop + step[1] * height, height) });
    const what = pointedAt(plot);
    if (what) setText(spoken, spokenReadings(kind, what.ago, what.found));
  }
  element.addEventListener("keydown", key);
  element.addEventListener("blur", () => plot?.setCursor(kNowhere));

  /// @param ratio  canvas pixels for each pixel of the page
  const font = (ratio: number) => `${0.75 * ratio * parseFloat(getComputedStyle(document.documentElement).fontSize)}px system-ui, sans-serif`;

  function axis(): uPlot.Axis {
    return {
      stroke: colours.quiet,
      grid: { stroke: colours.grid, width: 1 },
      ticks: { show: false },
      font: font(1),
    };
  }

  function build(): void {
    plot?.destroy();
    tip.hidden = true;
    curves = curvesOf(kind, chosen, name);
    colours = themes[name];
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
      hooks: { setCursor: [hover], draw: [(u) => drawCutOff(u, curves, strings.plots.units[kind], colours, () => font(uPlot.pxRatio))] },
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
      chosen = next;
      build();
    },
    setTheme(next) {
      name = next;
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
