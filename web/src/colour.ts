// SPDX-License-Identifier: Apache-2.0

/// A colour between two others, "#rrggbb". @param share  of the second one, 0 .. 1
export function mixed(first: string, second: string, share: number): string {
  const part = (colour: string, at: number) => parseInt(colour.slice(at, at + 2), 16);
  const mix = (at: number) => Math.round((1 - share) * part(first, at) + share * part(second, at));
  return `#${[1, 3, 5].map((at) => mix(at).toString(16).padStart(2, "0")).join("")}`;
}
