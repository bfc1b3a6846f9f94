// SPDX-License-Identifier: Apache-2.0
// Curves with no more points than can be seen. Of each bin of time the smallest and the largest value of each curve are kept, in their
// order, so that a peak never vanishes. Bins lie at multiples of their width, so that they stand still while the curves pass.
import type { History } from "../state/history";
import type { Curve } from "./plot_kinds";
import type { Span } from "./time_view";

const kSamplesPerBin = 4; // with fewer of them, all are drawn

export interface Points {
  readonly time: Float64Array;
  readonly values: readonly Float32Array[]; // of each curve, as displayed
}

/// Places at which bins begin, then the end.
function beginsOf(time: Float64Array, first: number, last: number, width: number): number[] {
  const begins: number[] = [];
  let bin = NaN;
  for (let i = first; i < last; ++i) {
    const here = Math.floor(time[i]! / width);
    if (here === bin) continue;
    begins.push(i);
    bin = here;
  }
  begins.push(last);
  return begins;
}

/// @param out  two values for each bin: the smaller and the larger one in the order of time. NaN counts only where there is nothing else
function fillExtremes(values: Float32Array, begins: readonly number[], scale: number, out: Float32Array): void {
  for (let bin = 0; bin + 1 < begins.length; ++bin) {
    let [low, high] = [begins[bin]!, begins[bin]!];
    for (let i = low + 1; i < begins[bin + 1]!; ++i) {
      const value = values[i]!;
      if (value < values[low]! || Number.isNaN(values[low]!)) low = i;
      if (value > values[high]! || Number.isNaN(values[high]!)) high = i;
    }
    out[2 * bin] = scale * values[Math.min(low, high)]!;
    out[2 * bin + 1] = scale * values[Math.max(low, high)]!;
  }
}

/// @param span  of which one sample more on each side is drawn
/// @param bins  that can be told apart in it
export function pointsOf(history: History, curves: readonly Curve[], span: Span, bins: number): Points {
  const time = history.time();
  const first = Math.max(0, history.firstFrom(span.from) - 1);
  const last = Math.min(time.length, history.firstFrom(span.to) + 1);
  if (last - first <= kSamplesPerBin * bins) {
    const scaled = ({ channel, scale }: Curve) => {
      const values = history.channel(channel.index).subarray(first, last);
      return scale === 1 ? values : values.map((value) => value * scale);
    };
    return { time: time.subarray(first, last), values: curves.map(scaled) };
  }
  const begins = beginsOf(time, first, last, (span.to - span.from) / bins);
  const thin = new Float64Array(2 * (begins.length - 1));
  for (let bin = 0; bin + 1 < begins.length; ++bin) {
    thin[2 * bin] = time[begins[bin]!]!;
    thin[2 * bin + 1] = time[begins[bin + 1]! - 1]!;
  }
  const values = curves.map(({ channel, scale }) => {
    const out = new Float32Array(thin.length);
    fillExtremes(history.channel(channel.index), begins, scale, out);
    return out;
  });
  return { time: thin, values };
}
