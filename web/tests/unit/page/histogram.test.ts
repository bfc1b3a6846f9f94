// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { barHeights, duration, usedOctaves } from "../../../src/panels/histogram";

describe("durations", () => {
  it("are read in their own unit", () => {
    expect([duration(0.1), duration(88.44), duration(1210), duration(3.3e6), duration(NaN)]).toEqual(["0.1 µs", "88.4 µs", "1.21 ms", "3.3 s", "–"]);
    expect([duration(0), duration(2.22e-10), duration(0.0123)]).toEqual(["0 µs", "0 µs", "0.012 µs"]); // a clock's rounding is no duration
  });

  it("one late step among a million still has a bar", () => {
    const counts = [0n, 1_000_000n, 0n, 1n, 0n];
    expect(usedOctaves(counts)).toEqual([1, 3]);
    expect(usedOctaves([0n, 0n])).toBeNull();
    const heights = barHeights(counts);
    expect(heights[1]).toBe(1);
    expect(heights[2]).toBe(0);
    expect(heights[3]).toBeGreaterThan(0.1);
  });
});
