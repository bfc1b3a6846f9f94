// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { curvesOf, type PlotKind } from "../../../src/plots/plot_kinds";
import { readings, spokenReadings, tipLines } from "../../../src/plots/readings";
import { strings } from "../../../src/strings";

const thumbAndIndex = [true, true, false, false, false];
const curves = (kind: PlotKind) => curvesOf(kind, thumbAndIndex, "dark");
const at = (kind: PlotKind, values: readonly number[], pointer: number) =>
  readings(kind, curves(kind), values, (value) => Math.abs(value - pointer));

describe("the values pointed at", () => {
  it("come in the order of their distance from the pointer, not of their size", () => {
    const found = at("force", [5, 1, 2.5, 0, 0, 9], 2);
    expect(found.map((one) => one.value)).toEqual([2.5, 1, 5, 9]);
    expect(found[0]!.curve.label).toBe("Thumb tip sent");
  });

  it("leave out forces of zero, which are not drawn, and what is not known", () => {
    expect(at("force", [0, NaN, 1], 0).map((one) => one.value)).toEqual([1]);
  });

  it("hold a joint at zero degrees and a torque at rest", () => {
    expect(at("angle", [0, 30], 0).map((one) => one.value)).toEqual([0, 30]);
    expect(at("torque", [0, 0.1], 0).map((one) => one.value)).toEqual([0, 0.1]);
    expect(tipLines("angle", -1, at("angle", [0], 0)).map((line) => line.textContent)).toEqual(["-1.00 s", "Thumb flexion shown0 °"]);
  });

  it("say how many are left out, and that there is nothing", () => {
    const many = at("torque", [1, 2, 3, 4, 5, 6, 7, 8], 0);
    const eleven = [...many, ...many.slice(0, 3)];
    expect(tipLines("torque", 0, eleven).at(-1)!.textContent).toBe(strings.plots.more(3));
    expect(tipLines("force", 0, []).at(-1)!.textContent).toBe(strings.plots.nothing);
    expect(spokenReadings("force", 0, [])).toBe(`0.0 s, ${strings.plots.nothing}`);
  });
});
