// SPDX-License-Identifier: Apache-2.0
import type { Points } from "./decimate";
import type { Span } from "./time_view";
import { leftOut } from "./stretches";

export type Point = readonly [number, number]; // time [s], value

/// The drawn parts of a curve: without pauses, unknown values and forces of zero. @param curve  its number in the points
export function polylines({ time, values }: Points, curve: number, pauses: readonly Span[], force: boolean): Point[][] {
  const own = values[curve]!;
  const hidden = new Uint8Array(own.length); // 1: nothing is drawn from here to the next point
  const skipped = new Uint8Array(own.length); // 1: the point itself is left out
  for (const [from, to] of leftOut(own, force)) {
    const unknown = Number.isNaN(own[from]) || Number.isNaN(own[to]);
    if (from === to && !unknown) continue; // a single zero is a point of the curve
    for (let i = from; i <= to; ++i) {
      hidden[i] = i < to || Number.isNaN(own[i]) ? 1 : 0;
      skipped[i] = Number.isNaN(own[i]) || (i > from && i < to) ? 1 : 0;
    }
  }
  const paused = new Set(pauses.map(({ from }) => from));
  const lines: Point[][] = [];
  let line: Point[] = [];
  const finish = () => {
    if (line.length > 1) lines.push(line);
    line = [];
  };
  for (let i = 0; i < own.length; ++i) {
    if (skipped[i]) finish();
    else line.push([time[i]!, own[i]!]);
    if (hidden[i] || paused.has(time[i]!)) finish();
  }
  finish();
  return lines;
}
