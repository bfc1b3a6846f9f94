// SPDX-License-Identifier: Apache-2.0
// One scale of forces for the digits' bars, the tint of skin and object, and the arrows' lengths. It ends at the limit of a digit's force.

const kEndWithoutLimit = 10; // [N]
const kLongestArrow = 0.075; // at the end of the scale [m]
const kRounding = 0.05; // [N] figures have one decimal

export interface ForceScale {
  readonly end: number; // [N]
  readonly limit: number; // of a digit's force [N]; Infinity: none
}

/// @param limit  of a digit's force [N]; Infinity: it is off, or not known
export function forceScale(limit: number): ForceScale {
  const stated = limit > 0 && Number.isFinite(limit);
  return { end: stated ? limit : kEndWithoutLimit, limit: stated ? limit : Infinity };
}

/// Share of the scale, 0 .. 1; what is no number counts as no force.
export function shareOf({ end }: ForceScale, newtons: number): number {
  return newtons > 0 ? Math.min(1, newtons / end) : 0;
}

/// Length of a force's arrow [m].
export function arrowLength(scale: ForceScale, newtons: number): number {
  return kLongestArrow * shareOf(scale, newtons);
}

/// Whether the figure of a digit's force reaches the limit.
export function isAtLimit({ limit }: ForceScale, newtons: number): boolean {
  return newtons >= limit - kRounding;
}
