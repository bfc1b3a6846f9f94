// SPDX-License-Identifier: Apache-2.0
// What is drawn over the curves on the screen: stretches in which nothing is sent, events, and the curves' names at their ends.
import uPlot from "uplot";
import { strings } from "../strings";
import type { Theme } from "../theme";
import type { Cluster } from "./event_clusters";
import { labelPlaces } from "./ticks";
import type { Curve } from "./plot_kinds";
import type { Span } from "./time_view";

const kHatch = 9; // distance of the lines [px]
const kVeil = 0.6; // how much a curve that is not sent is greyed
const kMark = 4; // half a flag's width [px]
const kNear = 5; // between a curve's end and its name [px]
const kSample = 12; // length of the line beside a name [px]

/// A canvas's plot, its colours, and its type: sizes in canvas pixels.
export interface Sheet {
  readonly plot: uPlot;
  readonly colours: Theme;
  readonly size: number; // of the type
}

const fontOf = ({ size }: Sheet) => `${size}px system-ui, sans-serif`;

/// Curves in these stretches look like forces, and are none.
export function drawNotSent(sheet: Sheet, stretches: readonly Span[]): void {
  const { plot, colours } = sheet;
  const { ctx, bbox } = plot;
  const ratio = uPlot.pxRatio;
  for (const { from, to } of stretches) {
    const left = Math.max(bbox.left, plot.valToPos(from, "x", true));
    const right = Math.min(bbox.left + bbox.width, plot.valToPos(to, "x", true));
    if (right - left < 1) continue;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, bbox.top, right - left, bbox.height);
    ctx.clip();
    ctx.globalAlpha = kVeil;
    ctx.fillStyle = colours.panel;
    ctx.fillRect(left, bbox.top, right - left, bbox.height);
    ctx.globalAlpha = 1;
    ctx.strokeStyle = colours.grid;
    ctx.lineWidth = ratio;
    ctx.beginPath();
    const step = kHatch * ratio;
    for (let x = Math.floor((left - bbox.height) / step) * step; x < right; x += step) {
      ctx.moveTo(x, bbox.top + bbox.height);
      ctx.lineTo(x + bbox.height, bbox.top);
    }
    ctx.stroke();
    ctx.font = fontOf(sheet);
    const words = strings.plots.notSent;
    const width = ctx.measureText(words).width;
    if (width + 2 * kNear * ratio < right - left) {
      ctx.textAlign = "center";
      ctx.textBaseline = "middle";
      const middle = bbox.top + bbox.height / 2;
      ctx.fillStyle = colours.panel;
      ctx.fillRect((left + right - width) / 2 - kNear * ratio, middle - sheet.size * 0.75, width + 2 * kNear * ratio, 1.5 * sheet.size);
      ctx.fillStyle = colours.quiet;
      ctx.fillText(words, (left + right) / 2, middle);
    }
    ctx.restore();
  }
}

/// A diamond for a marker, a triangle for what is bad, a bar for all else: told apart by shape.
function drawFlag({ plot, colours }: Sheet, { kind }: Cluster, x: number, y: number): void {
  const { ctx } = plot;
  const half = kMark * uPlot.pxRatio;
  ctx.fillStyle = kind === "marker" ? colours.accent : kind === "bad" ? colours.bad : colours.quiet;
  ctx.beginPath();
  if (kind === "marker") {
    ctx.moveTo(x, y - half);
    ctx.lineTo(x + half, y);
    ctx.lineTo(x, y + half);
    ctx.lineTo(x - half, y);
  } else if (kind === "bad") {
    ctx.moveTo(x, y - half);
    ctx.lineTo(x + half, y + half);
    ctx.lineTo(x - half, y + half);
  } else {
    ctx.rect(x - half / 3, y - half, (2 * half) / 3, 2 * half);
  }
  ctx.fill();
}

/// A line at each flag, and its label where there is room up to the next one.
export function drawEvents(sheet: Sheet, clusters: readonly Cluster[]): void {
  const { plot, colours, size } = sheet;
  const { ctx, bbox } = plot;
  const ratio = uPlot.pxRatio;
  const places = clusters.map(({ time }) => plot.valToPos(time, "x", true));
  ctx.save();
  ctx.font = fontOf(sheet);
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  clusters.forEach((cluster, i) => {
    const x = places[i]!;
    const top = bbox.top - size * 0.65;
    ctx.strokeStyle = cluster.kind === "bad" ? colours.bad : colours.quiet;
    ctx.globalAlpha = 0.7;
    ctx.lineWidth = ratio;
    ctx.setLineDash([3 * ratio, 3 * ratio]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.globalAlpha = 1;
    drawFlag(sheet, cluster, x, top);
    const from = x + (kMark + 3) * ratio;
    const room = (places[i + 1] ?? bbox.left + bbox.width + 4 * size) - from - 2 * kMark * ratio;
    const several = cluster.events.length > 1 ? String(cluster.events.length) : "";
    const text = [cluster.label, several].find((words) => words !== "" && ctx.measureText(words).width <= room);
    if (!text) return;
    ctx.fillStyle = colours.quiet;
    ctx.fillText(text, from, top);
  });
  ctx.restore();
}

/// Width that the names need beside the plot [canvas px].
export function namesWidth({ plot, size }: Pick<Sheet, "plot" | "size">, names: readonly string[]): number {
  plot.ctx.font = fontOf({ plot, size } as Sheet);
  const widest = Math.max(0, ...names.map((name) => plot.ctx.measureText(name).width));
  return widest + (2 * kNear + kSample + 4) * uPlot.pxRatio;
}

/// @param names  of each curve; empty: it has none
/// @param ends  the value that each name stands beside; NaN: the curve is not drawn, and has no name
export function drawNames(sheet: Sheet, curves: readonly Curve[], names: readonly string[], ends: readonly number[]): void {
  const { plot, colours, size } = sheet;
  const { ctx, bbox } = plot;
  const ratio = uPlot.pxRatio;
  const named = curves.flatMap((curve, i) => (names[i] === "" || Number.isNaN(ends[i]) ? [] : [{ curve, name: names[i]!, value: ends[i]! }]));
  const wishes = named.map(({ value }) => Math.min(bbox.top + bbox.height, Math.max(bbox.top, plot.valToPos(value, "y", true))));
  const places = labelPlaces(wishes, 1.2 * size, bbox.top - size / 2, bbox.top + bbox.height + size / 2);
  if (!places) return;
  const left = bbox.left + bbox.width + kNear * ratio;
  ctx.save();
  ctx.font = fontOf(sheet);
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  named.forEach(({ curve, name }, i) => {
    ctx.strokeStyle = curve.colour;
    ctx.lineWidth = curve.width * ratio;
    ctx.setLineDash(curve.dash.map((length) => length * 0.5 * ratio));
    ctx.beginPath();
    ctx.moveTo(left, places[i]!);
    ctx.lineTo(left + kSample * ratio, places[i]!);
    ctx.stroke();
    ctx.fillStyle = colours.text;
    ctx.fillText(name, left + (kSample + kNear) * ratio, places[i]!);
  });
  ctx.restore();
}
