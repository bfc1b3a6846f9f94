// SPDX-License-Identifier: Apache-2.0
// The values at one moment, as read from a plot.
import { eventLabel, type Happened } from "../state/happened";
import { el } from "../panels/dom";
import { eventWords } from "../panels/plain_words";
import { strings } from "../strings";
import { isForce, unitOf, type Curve, type PlotKind } from "./plot_kinds";

const kShown = 8; // in the tip
const kSpoken = 5;
const kDecimals: Readonly<Record<PlotKind, number>> = { force: 2, segment: 2, torque: 3, angle: 0 };

export interface Reading {
  readonly curve: Curve;
  readonly value: number;
}

/// What is found at a moment.
export interface Found {
  readonly when: string; // "-2.35 s"
  readonly readings: readonly Reading[];
  readonly sent: boolean; // false: nothing is sent to the motors
  readonly events: readonly Happened[];
}

/// Nearest to the pointer first. A force of zero is not drawn, and so not read; a joint at zero is.
/// @param distance  of a value from the pointer
export function readings(
  kind: PlotKind,
  curves: readonly Curve[],
  values: readonly number[],
  distance: (value: number) => number,
): Reading[] {
  return curves
    .map((curve, i) => ({ curve, value: values[i] ?? NaN }))
    .filter(({ value }) => Number.isFinite(value) && !(isForce(kind) && value === 0))
    .sort((a, b) => distance(a.value) - distance(b.value));
}

export const figureText = (kind: PlotKind, value: number) => (Number.isFinite(value) ? value.toFixed(kDecimals[kind]) : strings.dash);
const valueText = (kind: PlotKind, value: number) => `${figureText(kind, value)} ${unitOf(kind)}`;
const eventText = ({ code, text }: Happened) => strings.plots.event(eventLabel(code), eventWords(code, text));

/// The lines of the tip.
export function tipLines(kind: PlotKind, found: Found): HTMLElement[] {
  const swatch = (colour: string) => {
    const made = el("span", { class: "swatch" });
    made.style.background = colour;
    return made;
  };
  const line = ({ curve, value }: Reading) => el("div", {}, swatch(curve.colour), curve.label, el("b", {}, valueText(kind, value)));
  const lines = found.readings.slice(0, kShown).map(line);
  const more = found.readings.length - lines.length;
  return [
    el("small", {}, found.when),
    ...found.events.slice(0, kShown).map((one) => el("div", { class: "plot-tip-event" }, eventText(one))),
    ...(found.events.length > kShown ? [el("small", {}, strings.plots.more(found.events.length - kShown))] : []),
    ...(lines.length > 0 ? lines : [el("div", {}, strings.plots.nothing)]),
    ...(more > 0 ? [el("small", {}, strings.plots.more(more))] : []),
    ...(found.sent || kind === "angle" ? [] : [el("div", { class: "plot-tip-unsent" }, strings.plots.notSent)]),
  ];
}

/// The same in short, for those who cannot see it.
export function spokenReadings(kind: PlotKind, found: Found): string {
  const values = found.readings.slice(0, kSpoken).map(({ curve, value }) => `${curve.label} ${valueText(kind, value)}`);
  return [
    found.when,
    ...found.events.slice(0, kSpoken).map(eventText),
    ...(values.length > 0 ? values : [strings.plots.nothing]),
    ...(found.sent || kind === "angle" ? [] : [strings.plots.notSent]),
  ].join(", ");
}
