// SPDX-License-Identifier: Apache-2.0

/// A stretch of time on the ticks' clock [s].
export interface Span {
  readonly from: number;
  readonly to: number;
}

export const ordered = (one: number, other: number): Span => ({ from: Math.min(one, other), to: Math.max(one, other) });
export const lengthOf = ({ from, to }: Span) => to - from;
