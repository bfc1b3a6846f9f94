// SPDX-License-Identifier: Apache-2.0
// Force as a colour: from the skin's own to orange, vermilion and a dark crimson. Its lightness falls all the way, so that it reads in
// grey and with any of the common colour-vision deficiencies; where it matters an arrow's length says the same.
import { themes } from "../theme";

export interface ForceStop {
  readonly newtons: number;
  readonly colour: string; // #rrggbb
}

/// Between two of them the colour is interpolated linearly in sRGB, beyond the last it stays. Close together at
/// small forces, where most of a session happens.
export const forceStops: readonly ForceStop[] = [
  { newtons: 0, colour: themes.dark.skin },
  { newtons: 0.8, colour: "#e69f00" },
  { newtons: 4, colour: "#d0480a" },
  { newtons: 10, colour: "#7a1238" },
];

/// Colour of a segment that presses with this force [N]; what is no number, or below zero, counts as none.
/// @returns "#rrggbb"
export function forceColour(newtons: number): string {
  const force = newtons > 0 ? newtons : 0;
  let below = forceStops[0]!;
  for (const above of forceStops) {
    if (force < above.newtons) {
      return mix(below, above, (force - below.newtons) / (above.newtons - below.newtons));
    }
    below = above;
  }
  return below.colour;
}

function mix(from: ForceStop, to: ForceStop, share: number): string {
  const a = parseInt(from.colour.slice(1), 16);
  const b = parseInt(to.colour.slice(1), 16);
  let mixed = 0;
  for (const shift of [16, 8, 0]) {
    const x = (a >> shift) & 255;
    const y = (b >> shift) & 255;
    mixed |= Math.round(x + (y - x) * share) << shift;
  }
  return "#" + mixed.toString(16).padStart(6, "0");
}
