// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { forceColour, forceStops } from "../../../src/view3d/force_colour";

/// CIE lightness L* of an sRGB colour, 0 .. 100.
function lightness(colour: string): number {
  const linear = [1, 3, 5].map((at) => {
    const share = parseInt(colour.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  const luminance = 0.2126 * linear[0]! + 0.7152 * linear[1]! + 0.0722 * linear[2]!;
  return luminance > 0.008856 ? 116 * Math.cbrt(luminance) - 16 : 903.3 * luminance;
}

describe("forceColour", () => {
  it("is the stops' colour at the stops", () => {
    for (const stop of forceStops) expect(forceColour(stop.newtons)).toBe(stop.colour);
  });
  it("is half way between two stops half way between their forces", () => {
    // #e69f00 at 0.8 N and #d0480a at 4 N: e6..d0 -> db, 9f..48 -> 73.5 -> 74, 00..0a -> 05
    expect(forceColour(2.4)).toBe("#db7405");
  });
  it("stays at the ends, and takes what is no force for none", () => {
    expect(forceColour(1000)).toBe(forceStops.at(-1)!.colour);
    for (const none of [0, -1, NaN, -Infinity]) expect(forceColour(none)).toBe(forceStops[0]!.colour);
  });
  it("gets darker all the way, so that it reads without colour", () => {
    let before = lightness(forceColour(0));
    for (let force = 0.25; force <= 10; force += 0.25) {
      const now = lightness(forceColour(force));
      expect(now).toBeLessThan(before);
      before = now;
    }
    expect(lightness(forceColour(0)) - lightness(forceColour(10))).toBeGreaterThan(40);
  });
});
