// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { FlashGuard, luminance } from "../../../src/patient/flash_guard";

const kRate = 60; // frames a second
/// Flashes of a picture of 16 cells over 5 s.
function counted(level: (t: number, cell: number) => number): number {
  const guard = new FlashGuard();
  for (let i = 0; i < 5 * kRate; ++i) guard.take(i / kRate, Array.from({ length: 16 }, (_, cell) => level(i / kRate, cell)));
  return guard.flashes;
}

describe("flashes", () => {
  it("are pairs of opposing changes within a second", () => {
    expect(counted((t) => 0.4 + 0.2 * Math.sin(2 * Math.PI * 2 * t))).toBe(2);
    expect(counted((t) => 0.4 + 0.2 * Math.sin(2 * Math.PI * 5 * t))).toBe(5);
    expect(counted((t) => (Math.floor(t * 10) % 2 === 0 ? 0.1 : 0.9))).toBe(5);
  });

  it("are none where the change is small, slow, bright or in a small area", () => {
    expect(counted((t) => 0.4 + 0.04 * Math.sin(2 * Math.PI * 8 * t))).toBe(0);
    expect(counted((t) => 0.2 + 0.1 * t)).toBe(0);
    expect(counted((t) => 0.92 + 0.07 * Math.sin(2 * Math.PI * 8 * t))).toBe(0);
    expect(counted((t, cell) => (cell < 3 ? 0.4 + 0.3 * Math.sin(2 * Math.PI * 8 * t) : 0.4))).toBe(0);
  });

  it("have the luminance of WCAG", () => {
    expect([luminance(0, 0, 0), luminance(255, 255, 255)]).toEqual([0, 1]);
    expect(luminance(119, 119, 119)).toBeCloseTo(0.184, 3);
  });
});
