// SPDX-License-Identifier: Apache-2.0
import { beforeEach, expect, it } from "vitest";
import { keep, optionsOf, queryOf } from "../../../src/patient/options";

beforeEach(() => localStorage.clear());

it("options of the address come before those of the browser's memory, and both before the defaults", () => {
  expect(optionsOf("")).toMatchObject({ language: "", aphasia: false, numbers: false, cues: "centre", sound: true, speech: true });
  keep({ ...optionsOf(""), aphasia: true, cues: "left", sound: false });
  expect(optionsOf("")).toMatchObject({ aphasia: true, cues: "left", sound: false });
  expect(optionsOf("?aphasia=0&cues=right&lang=de")).toMatchObject({ aphasia: false, cues: "right", sound: false, language: "de" });
});

it("a query says all options, and unknown values change none", () => {
  const options = { ...optionsOf(""), language: "de", numbers: true, calm: true, cues: "right" as const };
  expect(optionsOf(queryOf(options))).toEqual(options);
  expect(optionsOf("?numbers=yes&cues=up&lang=German&calm=2")).toEqual(optionsOf(""));
});

it("the language is that of the cockpit until this screen has one", () => {
  localStorage.setItem("phalanx.language", "de");
  expect(optionsOf("").language).toBe("de");
  expect(optionsOf("?lang=en").language).toBe("en");
});
