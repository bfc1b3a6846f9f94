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
  it("are seen on the background of either theme, whether or not the finger slips", () => {
    for (const { arrow, slip, ghost, background } of Object.values(themes)) {
      expect(contrast(arrow, background)).toBeGreaterThanOrEqual(kLeast);
      expect(contrast(slip, background)).toBeGreaterThanOrEqual(kLeast);
      expect(new Set([slip, arrow, ghost]).size).toBe(3);
    }
  });
});
