// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { digitColours, themes, type ThemeName } from "../../../src/theme";

const kLeast = 3; // WCAG 2.2, 1.4.11: what is not text

/// WCAG's relative luminance of "#rrggbb".
function luminance(colour: string): number {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const value = parseInt(colour.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
}
function contrast(a: string, b: string): number {
  const [dark, light] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (light! + 0.05) / (dark! + 0.05);
}

describe("the digits' colours", () => {
  it("are seen as thin lines on the plots of either theme", () => {
    expect(contrast("#000000", "#ffffff")).toBeCloseTo(21, 6);
    for (const theme of Object.keys(themes) as ThemeName[]) {
      for (const colour of digitColours[theme]) expect(contrast(colour, themes[theme].panel), `${colour}, ${theme}`).toBeGreaterThanOrEqual(kLeast);
    }
  });
});

describe("arrows of forces", () => {
  it("have the digits' colours, and are seen on the background of either theme; the palm's and hollow ones are others", () => {
    for (const name of Object.keys(themes) as ThemeName[]) {
      const { arrow, quiet, ghost, background } = themes[name];
      for (const colour of [arrow, quiet, ...digitColours[name]]) expect(contrast(colour, background), colour).toBeGreaterThanOrEqual(kLeast);
      expect(new Set([arrow, quiet, ghost, ...digitColours[name]]).size).toBeGreaterThanOrEqual(7);
    }
  });
});
