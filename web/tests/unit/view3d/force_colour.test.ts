// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { forceStops, forceTint } from "../../../src/view3d/force_colour";
import { kSkinTones, skinTones } from "../../../src/view3d/skin_tones";

/// CIE L*a*b* of an sRGB colour.
function lab(colour: string): [number, number, number] {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const share = parseInt(colour.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  const f = (t: number): number => (t > 0.008856 ? Math.cbrt(t) : 7.787 * t + 16 / 116);
  const x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
  const y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
  const z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}
const lightness = (colour: string): number => lab(colour)[0];

describe("forceTint", () => {
  const last = forceStops.at(-1)!;

  it("is the stops' colour at the stops", () => {
    for (const stop of forceStops) expect(forceTint(stop.at)).toEqual({ colour: stop.colour, share: 1 });
  });
  it("is half way between two stops half way between their shares", () => {
    // #f2a600 at 0.12 and #d0480a at 0.5: f2..d0 -> e1, a6..48 -> 77, 00..0a -> 05
    expect(forceTint(0.31).colour).toBe("#e17705");
  });
  it("begins with none of it, and its share rises up to the first stop", () => {
    expect(forceTint(0).share).toBe(0);
    expect(forceTint(0.03).share).toBeCloseTo(0.25, 6);
    expect(forceTint(0.03).colour).toBe(forceStops[0]!.colour);
  });
  it("stays at the end", () => expect(forceTint(100).colour).toBe(last.colour));
  it("gets darker all the way, so that it reads without colour", () => {
    let before = Infinity;
    for (let share = 0.13; share <= 1; share += 0.02) {
      const now = lightness(forceTint(share).colour);
      expect(now).toBeLessThan(before);
      before = now;
    }
    expect(lightness(forceTint(0.12).colour) - lightness(forceTint(1).colour)).toBeGreaterThan(40);
  });
  it("is told from the skin of every tone, palm and back, at every force", () => {
    const kLeast = 25; // CIE 1976; 2.3 is just noticeable
    for (const name of kSkinTones) {
      for (const skin of [skinTones[name].skin, skinTones[name].palm, skinTones[name].flush]) {
        for (let share = 0.12; share <= 1; share += 0.04) {
          const [from, to] = [lab(skin), lab(forceTint(share).colour)];
          expect(Math.hypot(...from.map((x, k) => x - to[k]!)), `${name} ${skin}, ${share}`).toBeGreaterThan(kLeast);
        }
      }
    }
  });
});

describe("skin tones", () => {
  it("are at least five, from light to dark, each with a lighter palm", () => {
    const tones = kSkinTones.map((name) => lightness(skinTones[name].skin));
    expect(tones.length).toBeGreaterThanOrEqual(5);
    tones.slice(1).forEach((tone, i) => expect(tone).toBeLessThan(tones[i]! - 5));
    for (const name of kSkinTones) expect(lightness(skinTones[name].palm)).toBeGreaterThan(lightness(skinTones[name].skin));
  });
});
