// SPDX-License-Identifier: Apache-2.0
// One plot, drawn by uPlot from the history's own storage.
import uPlot from "uplot";
import { channelsOf } from "../state/channels";
import type { Shown } from "../state/shown";
import { strings } from "../strings";
import { themes, type ThemeName } from "../theme";
import { clockTime } from "../panels/as_text";
import { el, setText } from "../panels/dom";
import { bands, type Bands } from "./bands";
import { drawEvents, drawNames, drawNotSent, namesWidth, type Sheet } from "./canvas_marks";
import { drawCutOff } from "./cut_off";
import { pointsOf, type Points } from "./decimate";
import { clustersOf } from "./event_clusters";
import { curvesOf, isForce, titleOf, unitOf, type Curve, type PlotChoice, type PlotKind } from "./plot_kinds";
import { readings, spokenReadings, tipLines, type Found } from "./readings";
import { leftOut, notSent, pausesOf } from "./stretches";
import { decimalsOf, multiples, timeStep } from "./ticks";
import { lengthOf, ordered, type Span, type TimeView } from "./time_view";
import { valueRange } from "./value_range";

const kLineEnd = 4; // how far a line reaches beyond its first point [px]
const kSettled = 0.04; // share of the shown time whose mean places a curve's name: names stand still while a force shakes
const kNamesFrom = 26; // width of a plot from which on its curves have their whole names at their ends [rem]
const kFlag = 22; // events so near become one flag [px]
const kAtEvent = 8; // the cursor so near to an event shows it [px]
const kMinutes = 120; // longer spans are read in minutes [s]
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
const factor = channelsOf("factor")[0]!.index;

export interface Chart {
  readonly element: HTMLElement;
  readonly curves: () => readonly Curve[];
  readonly named: () => boolean; // the curves have their whole names at their ends
  setChoice(choice: PlotChoice): void;
  setTheme(theme: ThemeName): void;
  draw(): void;
  resize(): void;
  dispose(): void;
}

/// @param selects  whether a drag selects; otherwise it zooms
export function chart(
  kind: PlotKind,
  shown: Shown,
  view: TimeView,
  firstChoice: PlotChoice,
  theme: ThemeName,
  selects: () => boolean,
): Chart {
  const { history } = shown;
  let choice = firstChoice;
  let name = theme;
  let curves: readonly Curve[] = [];
  let colours = themes[theme];
  let plot: uPlot | null = null;
  let overlay: Bands | undefined;
  let span: Span = view.span; // that is drawn
  let pauses: readonly Span[] = [];
  let ends: readonly number[] = [];
  let anchor: number | undefined; // where a selection by keys began [s]
  const tip = el("div", { class: "plot-tip", hidden: true });
  const host = el("div", { class: "plot-host" });
  const spoken = el("span", { class: "visually-hidden", role: "status" });
  const element = el("div", { class: "plot", tabindex: 0, role: "application" }, host, tip, spoken);

  const rem = () => parseFloat(getComputedStyle(document.documentElement).fontSize) || 16;
  const typeSize = () => 0.75 * rem(); // [px]
  const sheet = (): Sheet => ({ plot: plot!, colours, size: typeSize() * uPlot.pxRatio });
  const named = () => host.clientWidth >= kNamesFrom * rem() && host.clientHeight >= (1.2 * curves.length + 5) * typeSize();
  const names = () => curves.map(named() ? ({ short }) => short : ({ letter }) => letter);
  const plotWidth = (u: uPlot) => u.bbox.width / uPlot.pxRatio;
  const secondsFor = (u: uPlot, pixels: number) => (pixels / Math.max(1, plotWidth(u))) * lengthOf(span);

  function points(): Points {
    span = view.span;
    const found = pointsOf(history, curves, span, Math.max(host.clientWidth, 100));
    pauses = pausesOf(history.time(), span, history);
    ends = curves.map((curve, i) => endOf(curve, found.values[i]!));
    return found;
  }

  /// Mean of a curve's last values; NaN if nothing of it is drawn.
  function endOf({ channel, scale }: Curve, drawn: Float32Array): number {
    if (!drawn.some((value) => !Number.isNaN(value) && !(isForce(kind) && value === 0))) return NaN;
    const values = history.channel(channel.index);
    let [sum, count] = [0, 0];
    const last = Math.min(history.length, history.firstFrom(span.to) + 1);
    for (let i = history.firstFrom(span.to - kSettled * lengthOf(span)); i < last; ++i) {
      if (Number.isNaN(values[i]!)) continue;
      sum += values[i]!;
      ++count;
    }
    return count > 0 ? (scale * sum) / count : NaN;
  }

  function data(): uPlot.AlignedData {
    const { time, values } = points();
    return [time, ...values] as unknown as uPlot.AlignedData;
  }

  function gaps(u: uPlot, index: number): uPlot.Series.Gaps {
    const [times, values] = [u.data[0], u.data[index] ?? []];
    const toPixel = (time: number) => u.valToPos(time, "x", true);
    const at = (i: number) => toPixel(times[Math.min(times.length - 1, Math.max(0, i))]!);
    const unknown = (i: number) => Number.isNaN(values[i]);
    const out = leftOut(values, isForce(kind))
      .filter(([from, to]) => to > from || unknown(from))
      .map(([from, to]) => [at(unknown(from) ? from - 1 : from) - (from === 0 ? kLineEnd : 0), at(unknown(to) ? to + 1 : to)]);
    const still = pauses.map(({ from, to }) => [toPixel(from), toPixel(to)]);
    return [...still, ...out].sort((a, b) => a[0]! - b[0]!) as uPlot.Series.Gaps;
  }

  function series(curve: Curve): uPlot.Series {
    const { label, colour: stroke, width, dash } = curve;
    return { label, stroke, width, dash: [...dash], points: { show: false }, gaps: (u, index) => gaps(u, index) };
  }

  // ---- the cursor

  /// "-2.35 s", or the time of day of a part that was zoomed.
  function whenText(time: number, decimals: number): string {
    if (view.zoom && Number.isFinite(shown.utcOffset)) return clockTime(time + shown.utcOffset, decimals);
    return strings.plots.ago((time - history.end).toFixed(decimals));
  }

  /// The values at the cursor; undefined: there is no cursor.
  function pointedAt(u: uPlot): (Found & { readonly time: number }) | undefined {
    const { left = -1, top = 0 } = u.cursor;
    if (left < 0 || history.length === 0) return undefined;
    const at = history.nearest(u.posToVal(left, "x"));
    const time = history.time()[at]!;
    const here = curves.map(({ channel, scale }) => scale * history.channel(channel.index)[at]!);
    const reach = secondsFor(u, kAtEvent);
    return {
      time,
      when: whenText(time, 2),
      readings: readings(kind, curves, here, (value) => Math.abs(u.valToPos(value, "y") - top)),
      sent: history.channel(factor)[at] !== 0,
      events: shown.happened.filter((one) => Math.abs(one.time - u.posToVal(left, "x")) <= reach),
    };
  }

  function hover(u: uPlot): void {
    const what = pointedAt(u);
    if (what || !tip.hidden) view.pointed = what?.time ?? null;
    tip.hidden = what === undefined;
    if (!what) return;
    tip.replaceChildren(...tipLines(kind, what));
    const left = u.cursor.left ?? 0;
    const right = left < u.over.clientWidth / 2;
    tip.style.left = right ? `${left + u.over.offsetLeft + 14}px` : "auto";
    tip.style.right = right ? "auto" : `${host.clientWidth - u.over.offsetLeft - left + 14}px`;
  }

  // ---- keys, which also say aloud what they find; they begin at the newest values

  function goTo(u: uPlot, left: number, top: number): void {
    const inside = (value: number, most: number) => Math.min(most, Math.max(0, value));
    u.setCursor({ left: inside(left, plotWidth(u)), top: inside(top, u.bbox.height / uPlot.pxRatio) });
    const what = pointedAt(u);
    if (what) setText(spoken, spokenReadings(kind, what));
  }

  function goToEvent(u: uPlot, direction: 1 | -1): void {
    const { left = -1, top = 0 } = u.cursor;
    const from = left < 0 ? span.to : u.posToVal(left, "x");
    const near = secondsFor(u, 1);
    const inside = shown.happened.filter(({ time }) => time >= span.from && time <= span.to);
    const next = direction > 0 ? inside.find(({ time }) => time > from + near) : inside.filter(({ time }) => time < from - near).at(-1);
    if (next) goTo(u, u.valToPos(next.time, "x"), Math.max(0, top));
  }

  function move(u: uPlot, event: KeyboardEvent, step: readonly [number, number]): void {
    const [width, height] = [plotWidth(u), u.bbox.height / uPlot.pxRatio];
    const { left = -1, top = -1 } = u.cursor;
    const [fromLeft, fromTop] = left < 0 ? [width, height / 2] : [left, top];
    const timeBefore = u.posToVal(fromLeft, "x");
    goTo(u, fromLeft + step[0] * width, fromTop + step[1] * height);
    if (!event.shiftKey) anchor = undefined;
    else if (step[0] !== 0) view.selection = ordered((anchor ??= timeBefore), u.posToVal(u.cursor.left ?? 0, "x"));
  }

  function act(u: uPlot, event: KeyboardEvent): boolean {
    const step = kSteps[event.key];
    if (step) move(u, event, step);
    else if (event.key === "PageUp") goToEvent(u, -1);
    else if (event.key === "PageDown") goToEvent(u, 1);
    else if (event.key === "Enter" && view.selection && lengthOf(view.selection) > 0) view.zoom = view.selection;
    else if (event.key === "Backspace") view.zoom = undefined;
    else if (event.key === "Delete") view.selection = undefined;
    else return false;
    return true;
  }
  element.addEventListener("keydown", (event) => {
    if (!plot || event.ctrlKey || event.altKey || event.metaKey) return;
    if (act(plot, event)) event.preventDefault(); // the page's scrolling
  });
  element.addEventListener("blur", () => {
    anchor = undefined;
    plot?.setCursor(kNowhere);
  });

  // ---- what uPlot draws

  function axis(): uPlot.Axis {
    const font = `${typeSize()}px system-ui, sans-serif`;
    return { stroke: colours.quiet, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, font };
  }

  /// Seconds back from now, so that the figures stand still while the curves pass; times of day in a part that was zoomed.
  function timeTicks(u: uPlot): number[] {
    const label = (view.zoom ? 9 : 7) * typeSize();
    const step = timeStep(lengthOf(span), Math.floor(plotWidth(u) / label));
    const origin = view.zoom ? -(Number.isFinite(shown.utcOffset) ? shown.utcOffset : 0) : history.end;
    return multiples(span.from - origin, span.to - origin, step).map((time) => time + origin);
  }
  function timeLabels(times: number[]): string[] {
    const step = times.length > 1 ? times[1]! - times[0]! : 1;
    const minutes = !view.zoom && lengthOf(span) > kMinutes;
    return times.map((time) => {
      if (view.zoom) return whenText(time, decimalsOf(step));
      const ago = time - history.end || 0;
      return minutes ? strings.plots.agoMinutes((ago / 60).toFixed(0)) : strings.plots.ago(ago.toFixed(decimalsOf(step)));
    });
  }

  function drawOver(u: uPlot): void {
    if (!plot) plot = u; // the first time, while it is built
    if (kind !== "angle") drawNotSent(sheet(), notSent(history, span));
    drawEvents(sheet(), clustersOf(shown.happened, span, secondsFor(u, kFlag)));
    drawCutOff(u, curves, unitOf(kind), colours, () => `${sheet().size}px system-ui, sans-serif`);
    drawNames(sheet(), curves, names(), ends);
  }

  function build(): void {
    plot?.destroy();
    plot = null;
    tip.hidden = true;
    view.release();
    curves = curvesOf(kind, choice, name);
    colours = themes[name];
    element.setAttribute("aria-label", `${titleOf(kind, choice)}. ${strings.plots.keys}`);
    const { clientWidth: width, clientHeight: height } = host;
    const size = typeSize();
    const right: uPlot.PaddingSide = (u) => {
      const shown = names().filter((name) => name !== "");
      return shown.length > 0 ? namesWidth({ plot: u, size: size * uPlot.pxRatio }, shown) / uPlot.pxRatio : size;
    };
    const options: uPlot.Options = {
      width: Math.max(width, 80),
      height: Math.max(height, 60),
      padding: [1.4 * size, right, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false, setScale: false }, points: { show: false } },
      scales: {
        x: { time: false, range: () => [span.from, span.to] },
        y: { range: (_, low, high) => valueRange(kind, low, high) },
      },
      axes: [
        { ...axis(), size: 2 * size, gap: 4, splits: (u) => timeTicks(u), values: (_, at) => timeLabels(at) },
        { ...axis(), size: 3.6 * size, space: 2.2 * size },
      ],
      series: [{}, ...curves.map(series)],
      hooks: { setCursor: [hover], draw: [drawOver] },
    };
    plot = new uPlot(options, data(), host);
    overlay = bands(plot, view, selects);
    overlay.place();
  }

  function draw(): void {
    if (!plot) return;
    plot.setData(data(), true);
    overlay?.place();
  }

  build();
  return {
    element,
    curves: () => curves,
    named,
    setChoice(next) {
      choice = next;
      build();
    },
    setTheme(next) {
      name = next;
      build();
    },
    draw,
    resize() {
      const { clientWidth: width, clientHeight: height } = host;
      if (width > 0 && height > 0) plot?.setSize({ width, height });
      draw();
    },
    dispose() {
      plot?.destroy();
      plot = null;
      overlay = undefined;
    },
  };
}
