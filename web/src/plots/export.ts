// SPDX-License-Identifier: Apache-2.0
// What is saved of the plots: tables and figures.
import { channels } from "../state/channels";
import { toCsv, type Column } from "../state/csv";
import type { Shown } from "../state/shown";
import { verdictKinds } from "../state/verdict";
import { strings } from "../strings";
import { saveBlob, savedName } from "../panels/saving";
import { pointsOf } from "./decimate";
import { clustersOf } from "./event_clusters";
import { factsOf } from "./figure_facts";
import { figureSvg, rasterised, type Figure, type FigurePlot, type Svg } from "./figure";
import { axisOf, columnName, curvesOf, isForce, kindsOf, titleOf, unitOf, type PlotChoice, type PlotKind } from "./plot_kinds";
import { polylines } from "./polylines";
import { lengthOf, type Span } from "./time_view";
import { notSent, pausesOf } from "./stretches";
import { peaksBeyond, valueRange } from "./value_range";

const kBins = 800; // of a figure: two to each of its pixels
const kFlags = 12; // places for events side by side
const kPngScale = 2;
const words = strings.plots;

function columnsOf(shown: Shown): Column[] {
  const { geometry, circumstances } = shown;
  const named: Readonly<Record<string, Partial<Column>>> = {
    verdict: { text: (value) => verdictKinds[value] ?? "" },
    circumstances: { name: "scene", text: (value) => circumstances[value]?.scene ?? "" },
    stiffness: { unit: strings.units.stiffness, scale: 1 / 1000 },
    angle_measured: { unit: strings.units.degree, scale: 180 / Math.PI },
    angle_shown: { unit: strings.units.degree, scale: 180 / Math.PI },
  };
  return channels.map((channel) => ({
    name: columnName(channel, geometry?.segmentName ?? [], geometry?.jointName ?? []),
    unit: channel.unit,
    ...named[channel.quantity],
  }));
}

export const csvOf = (shown: Shown, { from, to }: Span): string => toCsv(shown.history, from, to, columnsOf(shown));

export function saveCsv(shown: Shown, span: Span): void {
  saveBlob(`${savedName(shown)}.csv`, new Blob([csvOf(shown, span)], { type: "text/csv" }));
}

function figurePlot(kind: PlotKind, shown: Shown, choice: PlotChoice, span: Span): FigurePlot {
  const { history } = shown;
  const all = curvesOf(kind, choice, "light");
  const points = pointsOf(history, all, span, kBins);
  const pauses = pausesOf(history.time(), span, history);
  let [low, high] = [Infinity, -Infinity];
  for (const values of points.values) {
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  const known = low <= high;
  const range = valueRange(kind, known ? low : null, known ? high : null);
  const peaks = all
    .flatMap(({ colour }, i) => {
      const values = points.values[i]!;
      return peaksBeyond(values, range[1]).map((at) => ({ colour, time: points.time[at]!, value: values[at]! }));
    })
    .filter(({ time }) => time >= span.from && time <= span.to);
  return {
    axis: axisOf(kind),
    range,
    peaks,
    beyond: peaks.length > 0 ? words.beyond(Math.max(...peaks.map(({ value }) => value)).toFixed(1), unitOf(kind)) : "",
    curves: all.map((curve, i) => ({ curve, lines: polylines(points, i, pauses, isForce(kind)) })),
    notSent: kind === "angle" ? [] : notSent(history, span),
  };
}

export function figureOf(shown: Shown, choice: PlotChoice, span: Span): Figure {
  const kinds = kindsOf[choice.subject];
  return {
    title: kinds.map((kind) => titleOf(kind, choice)).join(words.titleJoin),
    facts: factsOf(shown, span),
    span,
    timeAxis: words.axis(words.time, strings.units.second),
    notSentWords: words.notSent,
    plots: kinds.map((kind) => figurePlot(kind, shown, choice, span)),
    clusters: clustersOf(shown.happened, span, lengthOf(span) / kFlags),
  };
}

const svgOf = (shown: Shown, choice: PlotChoice, span: Span): Svg => figureSvg(figureOf(shown, choice, span));

export function saveSvg(shown: Shown, choice: PlotChoice, span: Span): void {
  saveBlob(`${savedName(shown)}.svg`, new Blob([svgOf(shown, choice, span).text], { type: "image/svg+xml" }));
}

/// @throws if the browser cannot draw the figure
export async function savePng(shown: Shown, choice: PlotChoice, span: Span): Promise<void> {
  const name = savedName(shown);
  const blob = await rasterised(svgOf(shown, choice, span), kPngScale);
  if (!blob) throw new Error("the figure has no picture");
  saveBlob(`${name}.png`, blob);
}
