// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { curvesOf, firstChoice, type PlotKind } from "../../../src/plots/plot_kinds";
import { readings, spokenReadings, tipLines, type Found } from "../../../src/plots/readings";
import { strings } from "../../../src/strings";

const curves = (kind: PlotKind) => curvesOf(kind, { ...firstChoice, digit: 0 }, "dark");
const at = (kind: PlotKind, values: readonly number[], pointer: number) =>
  readings(kind, curves(kind), values, (value) => Math.abs(value - pointer));
const found = (when: string, list: Found["readings"], more: Partial<Found> = {}): Found => ({ when, readings: list, sent: true, events: [], ...more });

describe("the values pointed at", () => {
  it("come in the order of their distance from the pointer, not of their size", () => {
    const list = at("segment", [5, 1, 2.5, 0, 0, 9], 2);
    expect(list.map((one) => one.value)).toEqual([2.5, 1, 5, 9]);
    expect(list[0]!.curve.label).toBe("Thumb tip sent");
  });

  it("leave out forces of zero, which are not drawn, and what is not known", () => {
    expect(at("force", [0, NaN, 1], 0).map((one) => one.value)).toEqual([1]);
  });

  it("hold a joint at zero degrees and a torque at rest", () => {
    expect(at("angle", [0, 30], 0).map((one) => one.value)).toEqual([0, 30]);
    expect(at("torque", [0, 0.1], 0).map((one) => one.value)).toEqual([0, 0.1]);
    expect(tipLines("angle", found("-1.00 s", at("angle", [0], 0))).map((line) => line.textContent)).toEqual(["-1.00 s", "Thumb flexion shown0 °"]);
  });

  it("say how many are left out, and that there is nothing", () => {
    const many = at("torque", [1, 2, 3, 4], 0);
    const eleven = [...many, ...many, ...many.slice(0, 3)];
    expect(tipLines("torque", found("0 s", eleven)).at(-1)!.textContent).toBe(strings.plots.more(3));
    expect(tipLines("force", found("0 s", [])).at(-1)!.textContent).toBe(strings.plots.nothing);
    expect(spokenReadings("force", found("0.0 s", []))).toBe(`0.0 s, ${strings.plots.nothing}`);
  });

  it("hold the events of the moment, and that nothing is sent, which no angle is", () => {
    const events = [{ time: 1, code: "stopped", text: "stopped the torque" }];
    const line = strings.plots.event(strings.replay.kinds["stopped"]!, "stopped the torque");
    const here = found("0 s", [], { events, sent: false });
    expect(tipLines("torque", here).map((one) => one.textContent)).toEqual(["0 s", line, strings.plots.nothing, strings.plots.notSent]);
    expect(spokenReadings("angle", here)).toBe(`0 s, ${line}, ${strings.plots.nothing}`);
  });
});
