// SPDX-License-Identifier: Apache-2.0
import type { History } from "../state/history";
import type { Curve } from "./plot_kinds";
import type { Span } from "./time_view";

/// What a curve does in a selection, as displayed. NaN: there are too few values.
export interface Statistics {
  readonly count: number; // of known values
  readonly first: number;
  readonly last: number;
  readonly mean: number;
  readonly peak: number; // with its sign, farthest from zero
  readonly deviation: number; // standard deviation of the sample
}

export function statisticsOf(history: History, { channel, scale }: Curve, span: Span): Statistics {
  const time = history.time();
  const values = history.channel(channel.index);
  let [count, mean, squares, peak] = [0, 0, 0, NaN];
  let [first, last] = [NaN, NaN];
  for (let i = history.firstFrom(span.from); i < time.length && time[i]! <= span.to; ++i) {
    const value = scale * values[i]!;
    if (Number.isNaN(value)) continue;
    if (count === 0) first = value;
    last = value;
    ++count;
    const away = value - mean;
    mean += away / count;
    squares += away * (value - mean);
    if (!(Math.abs(value) <= Math.abs(peak))) peak = value;
  }
  return { count, first, last, mean: count > 0 ? mean : NaN, peak, deviation: count > 1 ? Math.sqrt(squares / (count - 1)) : NaN };
}
