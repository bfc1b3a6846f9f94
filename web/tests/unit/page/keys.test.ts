// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { KeyInfoSchema, NumberRangeSchema, StateSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { replaceObject } from "../../../src/panels/object_change";
import { belongsTo, defaultOf, limitOf, settingOf, valueOf, within } from "../../../src/state/keys";

const key = (path: string, defaultValue = "", kinds: readonly (readonly [string, string])[] = []) =>
  create(KeyInfoSchema, { path, defaultValue, kind: kinds.map(([kind, value]) => ({ kind, defaultValue: value })) });

describe("within", () => {
  it("compares with bounds, open and closed", () => {
    const range = create(NumberRangeSchema, { min: 0, max: 15, minOpen: true });
    expect([0, 1e-9, 15, 15.01].map((value) => within(value, range))).toEqual([false, true, true, false]);
    const fall = create(NumberRangeSchema, { min: -1e6, max: 0, maxOpen: true });
    expect([-1e6, -1, 0].map((value) => within(value, fall))).toEqual([true, true, false]);
  });

  it("lets -inf through where it is allowed, and no other value that is not finite", () => {
    const range = { min: -Infinity, max: Infinity };
    expect(within(-Infinity, create(NumberRangeSchema, { ...range, minusInfinity: true }))).toBe(true);
    for (const value of [-Infinity, Infinity, NaN]) expect(within(value, create(NumberRangeSchema, range))).toBe(false);
  });
});

describe("keys", () => {
  it("a limit that is off or not stated is none", () => {
    expect(["5", "7.5", '"off"', "", "0"].map(limitOf)).toEqual([5, 7.5, Infinity, Infinity, Infinity]);
  });

  it("an object's key belongs to the kinds that have it, others to all", () => {
    const diameter = key("objects[].diameter_mm", "60", [["sphere", "60"]]);
    expect(["sphere", "box"].map((kind) => belongsTo(diameter, kind))).toEqual([true, false]);
    expect(belongsTo(key("objects[].position_mm"), "box")).toBe(true);
    expect(belongsTo(key("force.law"), "box")).toBe(true);
  });

  it("defaults follow the kind", () => {
    const diameter = key("objects[].diameter_mm", "60", [["bottle", "65"], ["cup", "75"], ["sphere", "60"]]);
    expect(["bottle", "cup", "sphere", "box"].map((kind) => defaultOf(diameter, kind))).toEqual(["65", "75", "60", "60"]);
    const extent = key("objects[].extent_mm", "[50, 50, 50]", [["box", "[50, 50, 50]"], ["putty_bar", "[100, 35, 30]"]]);
    expect(defaultOf(extent, "putty_bar")).toBe("[100, 35, 30]");
  });

  it("a value is what is stated, else the default", () => {
    const welcome = create(WelcomeSchema, { key: [key("objects[].size_mm", "100")] });
    const state = create(StateSchema, { value: [{ key: "objects.0.size_mm", value: "80" }] });
    expect(settingOf("objects[].size_mm")).toBe("objects.0.size_mm");
    expect(valueOf(state, welcome, "objects.0.size_mm")).toBe("80");
    expect(valueOf(create(StateSchema), welcome, "objects.0.size_mm")).toBe("100");
    expect(valueOf(state, welcome, "nobody.knows")).toBe("");
  });
});

describe("replaceObject", () => {
  it("keeps the place, takes earlier changes of the object away, and leaves others alone", () => {
    const state = create(StateSchema, {
      changed: [
        { key: "objects.0.size_mm", value: "120" },
        { key: "rate_hz", value: "500" },
      ],
      value: [
        { key: "objects.0.size_mm", value: "120" },
        { key: "objects.0.position_mm", value: "[1, 2, 3]" },
      ],
    });
    expect(replaceObject(state, [["kind", '"sphere"'], ["diameter_mm", "70"]])).toEqual([
      ["objects.0.size_mm", ""],
      ["objects.0", '{kind = "sphere", diameter_mm = 70, position_mm = [1, 2, 3]}'],
    ]);
  });
});
