// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { plainWords, settingLabel } from "../../../src/panels/plain_words";

describe("the station's texts", () => {
  it("name settings by their labels", () => {
    expect(plainWords("force.stiffness_n_per_mm = 900: beyond its range, >= 0, <= 100 N/mm; write a number within it")).toBe(
      "“Stiffness” = 900: beyond its range, >= 0, <= 100 N/mm; write a number within it",
    );
    expect(plainWords("objects.0.size_mm = 120; stabiliser.method = none")).toBe("“Size” = 120; “Stabiliser” = none");
    expect(plainWords("patient.press_n is not known")).toBe("patient.press_n is not known"); // without a label
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
});
