// SPDX-License-Identifier: Apache-2.0
// A figure for print as SVG: curves as vectors, text as text, light background. It can be read in a paper's column.
import { themes } from "../theme";
import type { Cluster } from "./event_clusters";
import type { Curve } from "./plot_kinds";
import type { Point } from "./polylines";
import type { Span } from "./time_view";
import { decimalsOf, labelPlaces, multiples, niceStep } from "./ticks";

export interface FigurePlot {
  readonly axis: string; // "Force [N]"
  readonly range: readonly [number, number];
  readonly peaks: readonly { readonly colour: string; readonly time: number }[]; // above the range
  readonly beyond: string; // how far they go; empty: there are none
  readonly curves: readonly { readonly curve: Curve; readonly lines: readonly Point[][] }[];
  readonly notSent: readonly Span[];
}

export interface Figure {
  readonly title: string;
  readonly facts: readonly string[]; // one statement each
  readonly span: Span;
  readonly timeAxis: string; // "Time [s]"
  readonly notSentWords: string;
  readonly plots: readonly FigurePlot[];
  readonly clusters: readonly Cluster[];
}

export interface Svg {
  readonly text: string;
  readonly width: number; // [px]
  readonly height: number;
}

/// Pixels: 127 mm wide at 96 a inch. In a column of 88 mm the type has 7 points.
const kWidth = 480;
const kMargin = 12;
const kTitle = 16;
const kType = 13;
const kSmall = 11.5;
const kLine = 16; // from line to line
const kAxisWidth = 58; // at the left, with its title and figures
const kPlotHeight = 190;
const kAxisHeight = 38; // below, likewise
const kFlagHeight = 16; // above, for events
const kSampleWidth = 22;
const kMark = 4; // of a peak beyond the plot: half its width, and its height
const kHalo = 'paint-order="stroke" stroke="#ffffff" stroke-width="3"'; // of words over curves
const kLetter = 0.56; // mean width of a letter, as a share of its size
const kStroke = 0.55; // a line's width, as a share of that on the screen
const kTimeTicks = 7;
const kValueTicks = 6;
const kFont = "sans-serif";
const colours = themes.light;

const escaped = (text: string) => text.replace(/[&<>"]/g, (letter) => `&#${letter.charCodeAt(0)};`);
const px = (value: number) => String(Number(value.toFixed(2)));
const widthOf = (text: string, size: number) => kLetter * size * text.length;

function text(words: string, x: number, y: number, more = "", size = kType, fill = colours.text): string {
  return `<text x="${px(x)}" y="${px(y)}" font-size="${size}" fill="${fill}" ${more}>${escaped(words)}</text>`;
}

function line(x1: number, y1: number, x2: number, y2: number, more: string): string {
  return `<line x1="${px(x1)}" y1="${px(y1)}" x2="${px(x2)}" y2="${px(y2)}" ${more}/>`;
}

function strokeOf({ colour, width, dash }: Curve): string {
  const dashes = dash.length > 0 ? ` stroke-dasharray="${dash.join(" ")}"` : "";
  return `fill="none" stroke="${colour}" stroke-width="${px(kStroke * width)}" stroke-linejoin="round"${dashes}`;
}

/// Statements in as many lines as they need, with a point between two of them.
function wrapped(facts: readonly string[], size: number): string[] {
  const lines: string[] = [];
  for (const fact of facts) {
    const longer = lines.length > 0 ? `${lines.at(-1)!} · ${fact}` : "";
    if (longer && widthOf(longer, size) <= kWidth - 2 * kMargin) lines[lines.length - 1] = longer;
    else lines.push(fact);
  }
  return lines;
}

/// The plot's field on the paper, and how values become places.
interface Field {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
  readonly x: (time: number) => number;
  readonly y: (value: number) => number;
}

function rect({ left, right, top, bottom }: Pick<Field, "left" | "right" | "top" | "bottom">, more = ""): string {
  return `<rect x="${px(left)}" y="${px(top)}" width="${px(right - left)}" height="${px(bottom - top)}" ${more}/>`;
}

function field(figure: Figure, plot: FigurePlot, top: number): Field {
  const names = Math.max(...plot.curves.map(({ curve }) => widthOf(curve.short, kSmall)), 0);
  const [left, right, bottom] = [kMargin + kAxisWidth, kWidth - kMargin - names - 8, top + kPlotHeight];
  const { from, to } = figure.span;
  const [low, high] = plot.range;
  return {
    left, right, top, bottom,
    x: (time) => left + ((time - from) / (to - from)) * (right - left),
    y: (value) => bottom - ((value - low) / (high - low)) * (bottom - top),
  };
}

function axes(figure: Figure, plot: FigurePlot, at: Field, last: boolean): string[] {
  const out: string[] = [];
  const [low, high] = plot.range;
  const step = niceStep((high - low) / kValueTicks);
  for (const value of multiples(low, high, step)) {
    const y = at.y(value);
    out.push(line(at.left, y, at.right, y, `stroke="${colours.grid}" stroke-width="0.6"`));
    out.push(text((value || 0).toFixed(decimalsOf(step)), at.left - 5, y + 4, 'text-anchor="end"', kSmall));
  }
  const { from, to } = figure.span;
  const timeStep = niceStep((to - from) / kTimeTicks);
  for (const time of multiples(0, to - from, timeStep)) {
    const x = at.x(from + time);
    out.push(line(x, at.bottom, x, at.bottom + 4, `stroke="${colours.text}" stroke-width="0.8"`));
    if (last) out.push(text(time.toFixed(decimalsOf(timeStep)), x, at.bottom + 16, 'text-anchor="middle"', kSmall));
  }
  out.push(rect(at, `fill="none" stroke="${colours.text}" stroke-width="0.8"`));
  const middle = (at.top + at.bottom) / 2;
  out.push(text(plot.axis, kMargin + 10, middle, `text-anchor="middle" transform="rotate(-90 ${px(kMargin + 10)} ${px(middle)})"`));
  if (last) out.push(text(figure.timeAxis, (at.left + at.right) / 2, at.bottom + 33, 'text-anchor="middle"'));
  return out;
}

function notSent(figure: Figure, plot: FigurePlot, at: Field): string[] {
  return plot.notSent.flatMap(({ from, to }) => {
    const [left, right] = [Math.max(at.left, at.x(from)), Math.min(at.right, at.x(to))];
    if (!(right > left)) return [];
    const band = { ...at, left, right };
    const veils = [rect(band, 'fill="#ffffff" fill-opacity="0.6"'), rect(band, 'fill="url(#hatch)"')];
    if (widthOf(figure.notSentWords, kSmall) >= right - left) return veils;
    return [...veils, text(figure.notSentWords, (left + right) / 2, at.top + 14, `text-anchor="middle" ${kHalo}`, kSmall, colours.quiet)];
  });
}

/// Marks at the upper edge where curves leave the plot, and how far they go, below the words for what is not sent.
function cutOff({ peaks, beyond }: FigurePlot, at: Field): string[] {
  if (beyond === "") return [];
  const mark = (x: number) => [[x, at.top], [x - kMark, at.top + kMark], [x + kMark, at.top + kMark]].map((point) => point.map(px).join()).join(" ");
  const marks = peaks.map(({ time, colour }) => `<polygon points="${mark(at.x(time))}" fill="${colour}"/>`);
  return [...marks, text(beyond, at.right - 4, at.top + 14 + kLine, `text-anchor="end" ${kHalo}`, kSmall)];
}

function events({ clusters }: Figure, at: Field, first: boolean): string[] {
  const out: string[] = [];
  clusters.forEach(({ time, label, kind, events: all }, i) => {
    const x = at.x(time);
    if (x < at.left || x > at.right) return;
    const colour = kind === "bad" ? colours.bad : colours.quiet;
    out.push(line(x, at.top - (first ? 4 : 0), x, at.bottom, `stroke="${colour}" stroke-width="0.9" stroke-dasharray="3 2.5"`));
    const next = clusters[i + 1];
    const room = (next ? at.x(next.time) : kWidth - kMargin) - x;
    const words = [label, String(all.length)].find((one) => widthOf(one, kSmall) < room);
    if (first && words) out.push(text(words, x, at.top - 6, "", kSmall, colour));
  });
  return out;
}

function names(plot: FigurePlot, at: Field): string[] {
  const drawn = plot.curves.filter(({ curve, lines }) => curve.short !== "" && lines.length > 0);
  const ends = drawn.map(({ lines }) => Math.min(at.bottom, Math.max(at.top, at.y(lines.at(-1)!.at(-1)![1]))));
  const places = labelPlaces(ends, kSmall + 1, at.top - 4, at.bottom + 4);
  return places ? drawn.map(({ curve }, i) => text(curve.short, at.right + 5, places[i]! + 4, "", kSmall, curve.colour)) : [];
}

function legend(curves: readonly Curve[], top: number): { readonly parts: string[]; readonly bottom: number } {
  const parts: string[] = [];
  let [x, y] = [kMargin, top];
  for (const curve of curves) {
    const width = kSampleWidth + 6 + widthOf(curve.label, kSmall) + 14;
    if (x > kMargin && x + width > kWidth - kMargin) [x, y] = [kMargin, y + kLine];
    parts.push(line(x, y - 4, x + kSampleWidth, y - 4, strokeOf(curve)), text(curve.label, x + kSampleWidth + 6, y, "", kSmall));
    x += width;
  }
  return { parts, bottom: y };
}

function drawPlot(figure: Figure, plot: FigurePlot, number: number, top: number): string[] {
  const at = field(figure, plot, top);
  const clip = `clip${number}`;
  const paths = plot.curves.map(({ curve, lines }) => {
    const point = ([time, value]: Point, i: number) => `${i === 0 ? "M" : "L"}${px(at.x(time))} ${px(at.y(value))}`;
    const d = lines.map((points) => points.map(point).join("")).join("");
    return `<path d="${d}" ${strokeOf(curve)}/>`;
  });
  return [
    `<clipPath id="${clip}">${rect(at)}</clipPath>`,
    ...axes(figure, plot, at, number === figure.plots.length - 1),
    `<g clip-path="url(#${clip})">${paths.join("")}</g>`,
    ...notSent(figure, plot, at),
    ...cutOff(plot, at),
    ...events(figure, at, number === 0),
    ...names(plot, at),
  ];
}

export function figureSvg(figure: Figure): Svg {
  const out: string[] = [text(figure.title, kMargin, kMargin + kTitle, 'font-weight="bold"', kTitle)];
  let y = kMargin + kTitle + 4;
  for (const words of wrapped(figure.facts, kSmall)) out.push(text(words, kMargin, (y += kLine), "", kSmall, colours.quiet));
  y += 10 + kFlagHeight;
  figure.plots.forEach((plot, i) => {
    out.push(...drawPlot(figure, plot, i, y));
    y += kPlotHeight + (i === figure.plots.length - 1 ? kAxisHeight : 14);
  });
  for (const plot of figure.plots) {
    const { parts, bottom } = legend(plot.curves.map(({ curve }) => curve), y + kLine);
    out.push(...parts);
    y = bottom + 4;
  }
  const height = Math.ceil(y + kMargin);
  const size = `width="${kWidth}" height="${height}"`;
  const head = `<svg xmlns="http://www.w3.org/2000/svg" ${size} viewBox="0 0 ${kWidth} ${height}" font-family="${kFont}">`;
  const hatch =
    `<defs><pattern id="hatch" width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">` +
    `<line x1="0" y1="0" x2="0" y2="6" stroke="${colours.grid}" stroke-width="1.4"/></pattern></defs>`;
  const paper = `<rect ${size} fill="#ffffff"/>`;
  return { text: [head, `<title>${escaped(figure.title)}</title>`, hatch, paper, ...out, "</svg>", ""].join("\n"), width: kWidth, height };
}

/// The same picture in pixels. @param scale  pixels of it for each pixel of the figure
export async function rasterised(svg: Svg, scale: number): Promise<Blob | null> {
  const url = URL.createObjectURL(new Blob([svg.text], { type: "image/svg+xml" }));
  try {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = Math.round(scale * svg.width);
    canvas.height = Math.round(scale * svg.height);
    canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
  } finally {
    URL.revokeObjectURL(url);
  }
}
