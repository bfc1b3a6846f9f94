// SPDX-License-Identifier: Apache-2.0
// Ticks of an axis, as many as have room, and places for labels beside it.

const kNice: readonly number[] = [1, 2, 5];
const kOfTime: readonly number[] = [10, 20, 30, 60, 120, 300, 600]; // [s]
const kMinutes = 120; // a longer span is read in minutes [s]

/// The smallest step of 1, 2 or 5 times a power of ten that is no smaller than this.
export function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  const found = [...kNice, 10].find((factor) => factor * power >= least * (1 - 1e-9));
  return (found ?? 10) * power;
}

/// @param count  most labels that have room
export function timeStep(seconds: number, count: number): number {
  const least = seconds / Math.max(1, count);
  if (least <= 5 && seconds <= kMinutes) return niceStep(least);
  return kOfTime.find((step) => step >= least && (seconds <= kMinutes || step % 60 === 0)) ?? seconds;
}

/// Multiples of the step from `from` to `to`, both included.
export function multiples(from: number, to: number, step: number): number[] {
  const list: number[] = [];
  for (let i = Math.ceil(from / step - 1e-6); i * step <= to + 1e-6 * step; ++i) list.push(i * step);
  return list;
}

/// Decimals that tell the multiples of a step apart.
export const decimalsOf = (step: number) => Math.max(0, -Math.floor(Math.log10(step) + 1e-9));

/// Places for labels beside each other's wishes: in the same order, without overlaps, as near to the wishes as that allows.
/// @param wishes  middle of each label [px]
/// @returns undefined: there is no room
export function labelPlaces(wishes: readonly number[], height: number, top: number, bottom: number): number[] | undefined {
  if (wishes.length * height > bottom - top) return undefined;
  const order = wishes.map((_, i) => i).sort((a, b) => wishes[a]! - wishes[b]! || a - b);
  const places = [...wishes];
  let next = top + height / 2;
  for (const i of order) next = (places[i] = Math.max(wishes[i]!, next)) + height;
  next = bottom - height / 2;
  for (const i of order.reverse()) next = (places[i] = Math.min(places[i]!, next)) - height;
  return places;
}
