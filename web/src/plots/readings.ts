// SPDX-License-Identifier: Apache-2.0
// The values at one moment, as read from a plot.
import { el } from "../panels/dom";
import { strings } from "../strings";
import type { Curve, PlotKind } from "./plot_kinds";

const kShown = 8; // in the tip
const kSpoken = 3;
const kDecimals: Readonly<Record<PlotKind, number>> = { force: 2, torque: 3, angle: 0 };

export interface Reading {
  readonly curve: Curve;
  readonly value: number;
}

/// Nearest to the pointer first. A force of zero is not drawn, and so not read; a joint at zero is.
/// @param distance  of a value from the pointer
export function readings(kind: PlotKind, curves: readonly Curve[], values: readonly number[], distance: (value: number) => number): Reading[] {
  return curves
    .map((curve, i) => ({ curve, value: values[i] ?? NaN }))
    .filter(({ value }) => Number.isFinite(value) && !(kind === "force" && value === 0))
    .sort((a, b) => distance(a.value) - distance(b.value));
}

const valueText = (kind: PlotKind, value: number) => `${value.toFixed(kDecimals[kind])} ${strings.plots.units[kind]}`;

/// The lines of the tip. @param ago  from now [s], negative
export function tipLines(kind: PlotKind, ago: number, found: readonly Reading[]): HTMLElement[] {
  const lines = found.slice(0, kShown).map(({ curve, value }) =>
    el("div", {}, el("span", { class: "swatch", "data-digit": curve.channel.digit }), curve.label, el("b", {}, valueText(kind, value))),
  );
  const more = found.length - lines.length;
  return [
    el("small", {}, strings.plots.ago(ago.toFixed(2))),
    ...(lines.length > 0 ? lines : [el("div", {}, strings.plots.nothing)]),
    ...(more > 0 ? [el("small", {}, strings.plots.more(more))] : []),
  ];
}

/// The same in short, for those who cannot see it.
export function spokenReadings(kind: PlotKind, ago: number, found: readonly Reading[]): string {
  const values = found.slice(0, kSpoken).map(({ curve, value }) => `${curve.label} ${valueText(kind, value)}`);
  return [strings.plots.ago(ago.toFixed(1)), ...(values.length > 0 ? values : [strings.plots.nothing])].join(", ");
}
