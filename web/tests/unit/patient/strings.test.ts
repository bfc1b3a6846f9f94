// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { patientLanguages } from "../../../src/patient/words";
import { en } from "../../../src/strings/patient_en";

const html = readFileSync(resolve(__dirname, "../../../patient.html"), "utf8");
type Text = string | ((...told: readonly string[]) => string);
const told: readonly string[] = ["21", "22"];
const said = (text: Text) => (typeof text === "string" ? text : text(...told));
const all = (value: object, path = ""): readonly (readonly [string, Text])[] =>
  Object.entries(value).flatMap(([name, one]: [string, unknown]) => (typeof one === "object" && one !== null ? all(one, `${path}.${name}`) : [[`${path}.${name}`, one as Text] as const]));

/// What is the same in English and in German.
const same: readonly string[] = ["STOP", "21 N", "21°", "21 s", "21: 22", "English", "Deutsch"];

describe.each(Object.entries(patientLanguages))("the texts of the patient's screen in %s", (code, texts) => {
  it("have the names of the English ones, in their order, and none is blank", () => {
    expect(all(texts).map(([path]) => path)).toEqual(all(en).map(([path]) => path));
    for (const [path, text] of all(texts)) expect(said(text).trim(), path).not.toBe("");
  });

  it("are translated, but for what is the same in both languages", () => {
    const english = new Map(all(en));
    const left = all(texts).filter(([path, text]) => said(text) === said(english.get(path)!) && !same.includes(said(text)));
    if (code !== "en") expect(left).toEqual([]);
  });

  it("say all that they are told", () => {
    for (const [path, text] of all(texts)) if (typeof text === "function") for (const word of told.slice(0, text.length)) expect(text(...told), path).toContain(word);
  });

  it("have six words for six faces", () => expect([texts.rating.painWords.length, texts.rating.tiredWords.length]).toEqual([6, 6]));
});

it("the page has no style or script of its own, which the station's policy would refuse", () => {
  expect(html).toContain(`<title>${en.title}</title>`);
  expect(html).not.toMatch(/<style|style=|<script(?![^>]* src=)/);
});
