// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { peaksBeyond, valueRange } from "../../../src/plots/value_range";

describe("a plot's axis", () => {
  it("holds zero and all values, and is never too narrow", () => {
    expect(valueRange("force", 0, 0.01)[1]).toBeGreaterThanOrEqual(1);
    expect(valueRange("force", 0, 4)[0]).toBe(0);
    const [low, high] = valueRange("torque", -0.3, 0.1);
    expect(low).toBeLessThan(-0.3);
    expect(high).toBeGreaterThan(0.1);
    expect(valueRange("angle", null, null)[1]).toBeGreaterThanOrEqual(10);
  });

  it("is not flattened by what the law asks of a stiff wall", () => {
    expect(valueRange("force", 0, 300)).toEqual(valueRange("force", 0, 10));
    expect(valueRange("angle", 0, 90)[1]).toBeGreaterThan(90);
  });
});

describe("what lies beyond", () => {
  it("is known by the highest value of each stretch", () => {
    expect(peaksBeyond([1, 11, 13, 12, 2, NaN, 20, null, 15], 10)).toEqual([2, 6, 8]);
    expect(peaksBeyond([1, 10, undefined], 10)).toEqual([]);
  });
});
