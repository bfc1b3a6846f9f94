// SPDX-License-Identifier: Apache-2.0
// The picture under the scrubber: a lane for the force on each digit, events above the lanes, missing steps hatched.
import { kDigits } from "../state/channels";
import { digitColours, themes, type ThemeName } from "../theme";
import type { Happening } from "./event_list";
import type { Overview } from "./overview";

export const kMarksHeight = 14; // [px], above the lanes
const kMark = 4; // half a mark's width [px]
const kLaneGap = 1;
const kHatch = 5; // distance of the lines [px]
const kCoarseAlpha = 0.45; // where neighbours stand for what is not read yet

/// Largest force on a digit in a range of bins; where none is known, that of the bin nearest before it. NaN: none.
function peakOf(overview: Overview, digit: number, from: number, to: number): { readonly force: number; readonly exact: boolean } {
  let force = NaN;
  for (let bin = from; bin <= to; ++bin) {
    const here = overview.peak[kDigits * bin + digit]!;
    if (!(force >= here) && !Number.isNaN(here)) force = here;
  }
  if (!Number.isNaN(force) || overview.progress === 1) return { force, exact: true };
  for (let bin = from - 1; bin >= 0; --bin) {
    const before = overview.peak[kDigits * bin + digit]!;
    if (!Number.isNaN(before)) return { force: before, exact: false };
  }
  return { force: NaN, exact: false };
}

function drawLanes(context: CanvasRenderingContext2D, overview: Overview, width: number, height: number, theme: ThemeName): void {
  const lane = (height - kMarksHeight) / kDigits;
  const scale = (lane - kLaneGap) / Math.max(overview.largest, 1e-9);
  for (let digit = 0; digit < kDigits; ++digit) {
    const bottom = kMarksHeight + lane * (digit + 1);
    context.fillStyle = themes[theme].grid;
    context.fillRect(0, bottom - kLaneGap, width, kLaneGap);
    context.fillStyle = digitColours[theme][digit]!;
    for (let x = 0; x < width; ++x) {
      const from = Math.floor((x / width) * overview.bins);
      const to = Math.max(from, Math.ceil(((x + 1) / width) * overview.bins) - 1);
      const { force, exact } = peakOf(overview, digit, from, to);
      if (!(force > 0)) continue;
      context.globalAlpha = exact ? 1 : kCoarseAlpha;
      const high = Math.max(1, force * scale);
      context.fillRect(x, bottom - kLaneGap - high, 1, high);
    }
    context.globalAlpha = 1;
  }
}

function drawHole(context: CanvasRenderingContext2D, left: number, right: number, height: number, theme: ThemeName): void {
  const width = Math.max(2, right - left);
  context.save();
  context.beginPath();
  context.rect(left, kMarksHeight, width, height - kMarksHeight);
  context.clip();
  context.fillStyle = themes[theme].panel;
  context.fillRect(left, 0, width, height);
  context.strokeStyle = themes[theme].quiet;
  context.lineWidth = 1;
  context.beginPath();
  for (let x = left - height; x < left + width; x += kHatch) {
    context.moveTo(x, height);
    context.lineTo(x + height, 0);
  }
  context.stroke();
  context.restore();
}

/// A diamond for a marker, a triangle for what is bad, a line for all else: told apart by shape.
function drawMark(context: CanvasRenderingContext2D, { kind }: Happening, x: number, height: number, theme: ThemeName): void {
  const colours = themes[theme];
  const middle = kMarksHeight / 2;
  context.fillStyle = kind === "marker" ? colours.accent : kind === "bad" ? colours.bad : colours.quiet;
  context.globalAlpha = 0.5;
  if (kind === "marker" || kind === "bad") context.fillRect(x - 0.5, kMarksHeight, 1, height - kMarksHeight);
  context.globalAlpha = 1;
  context.beginPath();
  if (kind === "marker") {
    context.moveTo(x, middle - kMark - 1);
    context.lineTo(x + kMark, middle);
    context.lineTo(x, middle + kMark + 1);
    context.lineTo(x - kMark, middle);
  } else if (kind === "bad") {
    context.moveTo(x, middle - kMark - 1);
    context.lineTo(x + kMark + 1, middle + kMark);
    context.lineTo(x - kMark - 1, middle + kMark);
  } else {
    context.rect(x - 0.75, middle - kMark, 1.5, 2 * kMark);
  }
  context.fill();
}

export interface Strip {
  readonly overview: Overview;
  readonly happenings: readonly Happening[];
  readonly seconds: number;
}

export function drawStrip(canvas: HTMLCanvasElement, { overview, happenings, seconds }: Strip, theme: ThemeName): void {
  const { clientWidth: width, clientHeight: height } = canvas;
  const context = canvas.getContext("2d");
  if (!context || width === 0 || height === 0) return;
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  context.scale(ratio, ratio);
  context.fillStyle = themes[theme].panel;
  context.fillRect(0, 0, width, height);
  drawLanes(context, overview, width, height, theme);
  const place = (time: number) => (seconds > 0 ? (time / seconds) * width : 0);
  for (const { begin, end } of overview.holes) drawHole(context, place(begin), place(end), height, theme);
  for (const one of happenings) if (one.kind !== "gap") drawMark(context, one, place(one.time), height, theme);
}
