// SPDX-License-Identifier: Apache-2.0

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
