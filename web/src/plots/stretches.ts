// SPDX-License-Identifier: Apache-2.0
// Stretches of time in which a curve is not drawn, or not sent.
import { channelsOf } from "../state/channels";
import type { History } from "../state/history";
import type { Span } from "./time_view";

const kPause = 0.25; // a longer time between two samples is a gap in the curve [s]
const factor = channelsOf("factor")[0]!.index;

/// Pauses between the samples, as places of the samples before and after them.
export function pausesOf(time: Float64Array, span: Span, history: History): Span[] {
  const pauses: Span[] = [];
  const last = Math.min(time.length, history.firstFrom(span.to) + 1);
  for (let i = Math.max(1, history.firstFrom(span.from)); i < last; ++i) {
    if (time[i]! - time[i - 1]! > kPause) pauses.push({ from: time[i - 1]!, to: time[i]! });
  }
  return pauses;
}

/// Stretches of a curve that are left out: values that are not known, and forces of zero, so that not all curves lie on the axis.
/// @returns places of the first and the last point of each
export function leftOut(values: ArrayLike<number | null | undefined>, force: boolean): (readonly [number, number])[] {
  const out: (readonly [number, number])[] = [];
  const isOut = (i: number) => (force && values[i] === 0) || Number.isNaN(values[i]);
  for (let i = 0; i < values.length; ++i) {
    if (!isOut(i)) continue;
    const from = i;
    while (i + 1 < values.length && isOut(i + 1)) ++i;
    out.push([from, i]);
  }
  return out;
}

/// Times in which nothing is sent to the motors.
export function notSent(history: History, span: Span): Span[] {
  const time = history.time();
  const factors = history.channel(factor);
  const last = Math.min(time.length, history.firstFrom(span.to) + 1);
  const found: Span[] = [];
  for (let i = Math.max(0, history.firstFrom(span.from) - 1); i < last; ++i) {
    if (factors[i] !== 0) continue;
    const from = time[i]!;
    while (i + 1 < last && factors[i + 1] === 0) ++i;
    found.push({ from, to: i + 1 < time.length ? time[i + 1]! : Math.max(time[i]!, span.to) });
  }
  return found;
}
