// SPDX-License-Identifier: Apache-2.0
// Force as a colour over skin and object: more and more of amber, then vermilion, then a dark crimson. Its lightness falls all the way, so
// that it reads in grey and with any of the common colour-vision deficiencies; an arrow's length says the same.
import { mixed } from "../colour";

export interface ForceStop {
  readonly at: number; // share of the scale of forces
  readonly colour: string; // #rrggbb
}

export interface ForceTint {
  readonly colour: string;
  readonly share: number; // of it over what is there without force, 0 .. 1
}

/// Between two of them the colour is interpolated linearly in sRGB, beyond the last it stays; below the first its share rises. Close
/// together at small forces, where most of a session happens.
export const forceStops: readonly ForceStop[] = [
  { at: 0.12, colour: "#f2a600" },
  { at: 0.5, colour: "#d0480a" },
  { at: 1, colour: "#8a1040" },
];

/// Tint of what presses with this share of the scale of forces.
export function forceTint(share: number): ForceTint {
  return { colour: colourOf(share), share: Math.min(1, share / forceStops[0]!.at) };
}

function colourOf(share: number): string {
  let below = forceStops[0]!;
  for (const above of forceStops) {
    if (share < above.at) return above === below ? below.colour : mixed(below.colour, above.colour, (share - below.at) / (above.at - below.at));
    below = above;
  }
  return below.colour;
}
