// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { eventWords, plainWords, settingLabel, valueLabel, whoText } from "../../../src/panels/plain_words";

describe("the station's texts", () => {
  it("name settings by their labels", () => {
    expect(plainWords("force.stiffness_n_per_mm = 900: beyond its range, >= 0, <= 100 N/mm; write a number within it")).toBe(
      "“Stiffness” = 900: beyond its range, >= 0, <= 100 N/mm; write a number within it",
    );
    expect(plainWords("objects.0.size_mm = 120; stabiliser.method = none")).toBe("“Size” = 120; “Stabiliser” = None");
    expect(plainWords("patient.press_n is not known")).toBe("patient.press_n is not known"); // without a label
  });

  it("name choices and flags by their labels, and an object by its kind", () => {
    expect(plainWords('force.law = "kelvin_voigt", grasp.other_types = true')).toBe("“Force law” = Kelvin–Voigt (with damping), “Other types allowed” = on");
    expect(plainWords("objects.0 = sphere, diameter_mm 60")).toBe("“Object” = Ball, Diameter 60");
    expect(plainWords('description = "a b", gdp.method = "no such"')).toBe('description = "a b", “Method of the displayed hand” = "no such"');
  });

  it("name pages without their addresses", () => {
    expect(plainWords("took control from page 1 (127.0.0.1), Anna")).toBe("took control from page 1, Anna");
    expect(plainWords("page 3 (fe80::1) operates; take control first")).toBe("page 3 operates; take control first");
  });

  it("leave a marker in its person's own words", () => {
    expect(eventWords("set", "force.law = hooke")).toBe("“Force law” = Hooke (linear)");
    expect(eventWords("marker", "force.law = hooke")).toBe("force.law = hooke");
  });

  it("name files without their folders", () => {
    expect(plainWords("written to out/faults/20261122-010000.json")).toBe("written to 20261122-010000.json");
    expect(plainWords("/home/anna/out/cockpit/meshes/knob.stl: 36 open edges")).toBe("knob.stl: 36 open edges");
    expect(plainWords("grasp.toml cannot be read")).toBe("grasp.toml cannot be read");
  });

  it("are left alone otherwise", () => {
    for (const text of ["see http://127.0.0.1:8480/a/b.html", "12.5 N/mm and 3 N/s", "0 <= x <= 1.5", "e.g. the index"]) expect(plainWords(text)).toBe(text);
  });
});

it("an index of an object is of no account for its label", () => {
  expect(settingLabel("objects.0.kind")).toBe(settingLabel("objects[].kind"));
  expect(settingLabel("objects.1.kind")).toBe("Shape");
  expect(settingLabel("no.such_key")).toBe("no.such_key");
  expect(valueLabel("objects.1.kind", "sphere")).toBe("Ball");
});

it("people and programs have no addresses", () => {
  const all = ["page 2 (127.0.0.1), Anna", "page 2 (fe80::1%eth0)", "a page (127.0.0.1)", "127.0.0.1", "the terminal", ""];
  expect(all.map((who) => whoText(who))).toEqual(["Anna (page 2)", "page 2", "a page", "a program", "the terminal", "station"]);
  expect(whoText("page 2 (127.0.0.1), Anna", 2)).toBe("you");
});
