// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { digitColours, themes, type ThemeName } from "../../../src/theme";
import { contrast, difference, lab, linear, seenIn, sights } from "./seen_colour";

const kContrast = 3; // WCAG 2.2, 1.4.11: what is not text
/// CIEDE2000. 1 is about what is just noticed between large patches that touch. Marks of a third of a degree that lie apart, such as a
/// legend's, need a CIE76 difference from 7 (lightness) to 14 (yellow and blue) to be told apart by half of the observers: Stone, Szafir and
/// Setlur, "An Engineering Model for Color Difference as a Function of Size", Color and Imaging Conference, 2014. 10 lies between.
const kApart = 10;
const names = Object.keys(themes) as ThemeName[];

describe("the measures", () => {
  it("are those of WCAG", () => expect(contrast(linear("#000000"), linear("#ffffff"))).toBeCloseTo(21, 6));

  it("are those of CIEDE2000, by pairs that its authors published", () => {
    const published = [
      [[50, 2.6772, -79.7751], [50, 0, -82.7485], 2.0425], [[50, -1, 2], [50, 0, 0], 2.3669], [[50, 2.5, 0], [50, 0, -2.5], 4.3065],
      [[50, 2.5, 0], [61, -5, 29], 22.8977], [[60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644],
      [[22.7233, 20.0904, -46.694], [23.0331, 14.973, -42.5619], 2.0373], [[2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082],
    ] as const;
    for (const [a, b, apart] of published) expect(difference(a, b)).toBeCloseTo(apart, 4);
    expect(lab(linear("#ffffff")).map((value) => Math.round(value) + 0)).toEqual([100, 0, 0]);
  });

  it("leave white as it is in every sight, and take red and green near to each other where one kind of cone is missing", () => {
    for (const sight of Object.values(sights)) seenIn(sight, [1, 1, 1]).forEach((part) => expect(part).toBeCloseTo(1, 5));
    const apart = (sight: string) => difference(lab(seenIn(sights[sight]!, linear("#c03000"))), lab(seenIn(sights[sight]!, linear("#5a7000"))));
    for (const sight of ["protanopia", "deuteranopia"]) expect(apart(sight), sight).toBeLessThan(apart("normal") / 2);
  });
});

describe.each(names)("in the %s theme", (name) => {
  const { arrow, background, panel, quiet } = themes[name];
  const digits = digitColours[name];

  it.each(Object.entries(sights))("the colours of digits and palm are told apart, and stand out from what is behind them: %s", (_, sight) => {
    const seen = (colour: string) => seenIn(sight, linear(colour));
    const colours = [...digits, arrow];
    for (const colour of colours) {
      for (const behind of [panel, background]) expect.soft(contrast(seen(colour), seen(behind)), `${colour} on ${behind}`).toBeGreaterThanOrEqual(kContrast);
    }
    colours.forEach((colour, i) => {
      for (const other of colours.slice(i + 1)) {
        expect.soft(difference(lab(seen(colour)), lab(seen(other))), `${colour} and ${other}`).toBeGreaterThanOrEqual(kApart);
      }
    });
  });

  it("hollow arrows are seen, and have the colour of no other", () => {
    expect(contrast(linear(quiet), linear(background))).toBeGreaterThanOrEqual(kContrast);
    expect([...digits, arrow]).not.toContain(quiet);
  });
});
