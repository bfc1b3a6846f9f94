// SPDX-License-Identifier: Apache-2.0
// The range of values that a plot shows, and the values beyond it.
import { isForce, type PlotKind } from "./plot_kinds";

const kSmallest: Readonly<Record<PlotKind, number>> = { force: 1, segment: 1, torque: 0.02, angle: 10 }; // span of the axis at least
/// No digit is sent more; what the law asks of a stiff wall may be many times that, and would flatten the curves that are felt [N].
const kMostForceShown = 10;

/// The axis: from zero or below to a little above, never narrower than what is worth looking at.
export function valueRange(kind: PlotKind, low: number | null, high: number | null): [number, number] {
  const least = kSmallest[kind];
  const both = kind === "torque"; // pushes both ways
  const min = Math.min(both ? -least / 2 : 0, low ?? 0);
  const highest = isForce(kind) ? Math.min(high ?? 0, kMostForceShown) : (high ?? 0);
  const max = Math.max(both ? least / 2 : least, highest);
  const room = 0.08 * (max - min);
  return [min < 0 ? min - room : 0, max + room];
}

/// Finds where a curve is cut off at the upper edge: the place of the highest value of each stretch beyond it.
export function peaksBeyond(values: ArrayLike<number | null | undefined>, top: number): number[] {
  const peaks: number[] = [];
  for (let i = 0; i < values.length; ++i) {
    if (!(Number(values[i]) > top)) continue;
    let peak = i;
    for (; i < values.length && Number(values[i]) > top; ++i) if (Number(values[i]) > Number(values[peak])) peak = i;
    peaks.push(peak);
  }
  return peaks;
}
