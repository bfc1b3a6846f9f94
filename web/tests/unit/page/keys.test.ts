// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { KeyInfoSchema, StateSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { replaceObject } from "../../../src/panels/object_change";
import { choicesOf, defaultOf, kindsOf, parseRange, settingOf, valueOf, within } from "../../../src/state/keys";

const key = (path: string, range = "", meaning = "", defaultValue = "") => create(KeyInfoSchema, { path, range, meaning, defaultValue });

describe("parseRange", () => {
  it("reads bounds, open and closed", () => {
    const range = parseRange("> 0, <= 15");
    expect(range).toMatchObject({ min: 0, max: 15, minOpen: true, maxOpen: false, words: [] });
    expect([within(0, range), within(1e-9, range), within(15, range), within(15.01, range)]).toEqual([false, true, true, false]);
  });

  it("reads words that may stand in a number's place", () => {
    expect(parseRange(">= -1000000, < 0, or -inf")).toMatchObject({ min: -1e6, max: 0, maxOpen: true, words: ["-inf"] });
    expect(parseRange('> 0, <= 15, or "off"').words).toEqual(["off"]);
  });

  it("knows no bounds where none are said, and never lets NaN through", () => {
    const range = parseRange("");
    expect(range).toMatchObject({ min: -Infinity, max: Infinity });
    expect(within(NaN, range)).toBe(false);
  });
});

describe("keys", () => {
  it("choices are the words of the range", () => {
    expect(choicesOf(key("force.law", "hooke, kelvin_voigt"))).toEqual(["hooke", "kelvin_voigt"]);
    expect(choicesOf(key("force.law", ""))).toEqual([]);
  });

  it("an object's key belongs to the kinds in brackets, others to all", () => {
    const kinds = ["sphere", "box", "file"];
    expect(kindsOf(key("objects[].diameter_mm", "", "(sphere) outer diameter"), kinds)).toEqual(["sphere"]);
    expect(kindsOf(key("objects[].position_mm", "", "the object's centre"), kinds)).toBeNull();
    expect(kindsOf(key("force.law", "", "(sphere) no object's"), kinds)).toBeNull();
    expect(kindsOf(key("objects[].x", "", "(of the tube) y"), kinds)).toBeNull();
  });

  it("defaults follow the kind", () => {
    const diameter = key("objects[].diameter_mm", "", "outer diameter; default of bottle 65, cup 75, pen 10", "60");
    expect(defaultOf(diameter, "cup")).toBe("75");
    expect(defaultOf(diameter, "bottle")).toBe("65");
    expect(defaultOf(diameter, "sphere")).toBe("60");
    const extent = key("objects[].extent_mm", "", "edges; default of putty_bar [100, 35, 30]", "[50, 50, 50]");
    expect(defaultOf(extent, "putty_bar")).toBe("[100, 35, 30]");
  });

  it("a value is what is stated, else the default", () => {
    const welcome = create(WelcomeSchema, { key: [key("objects[].size_mm", "", "", "100")] });
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
