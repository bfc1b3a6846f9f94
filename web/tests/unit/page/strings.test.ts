// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { ChangeKind, HandSource, KeyType, Notice_Level } from "../../../src/gen/phalanx/cockpit_pb";
import { valueLabel } from "../../../src/panels/plain_words";
import { groupOf } from "../../../src/panels/settings_list";
import { english, languages, type Strings } from "../../../src/strings";
import { literals, unusedTexts } from "./source_texts";

const keysOfDocs = readFileSync(resolve(__dirname, "../../../../docs/scenes.md"), "utf8");

/// The choices of a key in the table of docs/scenes.md.
function choices(key: string): string[] {
  const line = keysOfDocs.split("\n").find((one) => one.startsWith(`| \`${key}\` | choice`));
  return line?.split("|")[4]?.split(",").map((word) => word.trim()) ?? [];
}

type Text = string | ((...words: readonly string[]) => string);

/// Every text with where it stands.
function visit(value: unknown, path: string, found: (path: string, text: Text) => void): void {
  if (typeof value === "string" || typeof value === "function") found(path, value as Text);
  else if (Array.isArray(value)) value.forEach((one, i) => visit(one, `${path}[${i}]`, found));
  else for (const [name, one] of Object.entries(value as object)) visit(one, path === "" ? name : `${path}.${name}`, found);
}

function textsOf(texts: Strings): ReadonlyMap<string, Text> {
  const all = new Map<string, Text>();
  visit(texts, "", (path, text) => all.set(path, text));
  return all;
}

/// What texts are told: numbers, as most of it is.
const words: readonly string[] = ["21", "22", "23", "24", "25"];
const said = (text: Text) => (typeof text === "string" ? text : text(...words));

/// Texts with what they are told that chooses among wordings and is no part of them: its place.
const choosing: Readonly<Record<string, number>> = { "calibration.deviceEnd": 0, "calibration.rangeEnd": 0, "calibration.toGo": 2 };

/// Tables in the order of their keys, since some of them are listed on the page.
function shape(value: unknown): unknown {
  if (typeof value === "function") return `function of ${value.length}`;
  if (Array.isArray(value)) return value.map(shape);
  if (typeof value === "object" && value !== null) return Object.entries(value).map(([name, one]) => [name, shape(one)]);
  return typeof value;
}

/// What is the same in English and in another language: words, names, units, signs, keys, names of files and of columns.
const same: readonly string[] = [
  "Phalanx", "STOP", "Ball", "Hand", "Station", "Pause", "Hooke (linear)",
  "mm", "cm", "m", "N", "Nm", "N/s", "N/mm", "N/m", "Nm/s", "rad", "deg", "rad/s", "Hz", "s", "°",
  "21 mm", "21 µs", "21 ms", "21 s", "21 min", "21 MB", "21 GB", "21 Hz", "21°", "21×", "21 22 N", "99 %", "99.9 %",
  "M", "R", "x", "y", "z", "21 ↑", "21 = 22", "21 (22)", ", ",
  "–", "; ", "21, 22", "21: 22", "21 [22]", "21 ×22", "✕", "HTTP 21",
  "‹ Pose", "Pose ›", "CSV", "SVG", "PNG", "phalanx-fault-21.json", "time", "station_time", "thumb", "index", "middle", "ring", "little",
  "P", "← →", ", .", "< >", "1 2 3 4", "+ −", "Tab", "Esc", "?",
];

/// Texts that are those of English.
function untranslated(texts: Strings): readonly string[] {
  const theirs = textsOf(english.texts);
  return [...textsOf(texts)].filter(([path, text]) => said(text) === said(theirs.get(path) ?? "")).map(([, text]) => said(text));
}

const enumNames = (values: object) => Object.values(values).filter((value) => typeof value === "string").length;

describe.each(languages)("the texts in $code", ({ texts, reviewed }) => {
  it("are all there, and none is blank", () => {
    let count = 0;
    visit(texts, "", (path, text) => {
      ++count;
      expect(said(text).trim(), path).not.toBe("");
      expect(said(text), path).not.toContain("undefined");
    });
    expect(count).toBeGreaterThan(200);
  });

  it("are those of English, of the same kinds and in the same order", () => expect(shape(texts)).toEqual(shape(english.texts)));

  it("are translated, but for what is the same in both languages", () => {
    if (texts !== english.texts) expect(untranslated(texts).filter((text) => !same.includes(text))).toEqual([]);
  });

  it("say all that they are told", () => {
    for (const [path, text] of textsOf(texts)) {
      if (typeof text === "string") continue;
      const choice = choosing[path];
      words.slice(0, text.length).forEach((word, i) => i !== choice && expect(text(...words), path).toContain(word));
      if (choice === undefined) continue;
      const wording = (chosen: boolean) => (text as (...told: unknown[]) => string)(...words.map((word, i) => (i === choice ? chosen : word)));
      expect(wording(true), path).not.toBe(wording(false));
    }
    expect(texts.device.unsaved("", "21")).toContain("21");
    for (const one of [texts.people.looking(1), texts.view.viewCount(1), texts.scene.changes(1), texts.plots.windows(60)]) expect(one).toContain("1");
  });

  it("have the word on the button that presentations and documents show", () => expect(texts.stop.button).toBe("STOP"));

  it("have figures with a decimal point, as the page makes most of them", () => {
    const figure = (1234.5).toLocaleString(texts.figures);
    expect(figure).toMatch(/^1\D?234\.5$/);
    expect(figure).not.toMatch(/^1\./);
  });

  it("have a name, and one that both sorts of readers understand until they are reviewed", () => {
    const { name, unreviewedName, label } = texts.language;
    expect(new Intl.DisplayNames(texts.locale, { type: "language" }).of(texts.locale.slice(0, 2))).toBe(name);
    if (!reviewed) expect(unreviewedName(name)).toContain(english.texts.language.unreviewed);
    for (const word of english.texts.language.label.split(" / ")) expect(label).toContain(word);
  });

  it("name every value of the messages' enumerations", () => {
    expect(texts.hand.sources.length).toBe(enumNames(HandSource));
    expect(texts.settings.change.length).toBe(enumNames(ChangeKind));
    expect(texts.settings.types.length).toBe(enumNames(KeyType));
    expect(texts.notice.levels.length).toBe(enumNames(Notice_Level));
  });

  it("name every choice that a scene may make", () => {
    const all = [...keysOfDocs.matchAll(/^\| `([a-z0-9_.[\]]+)` \| choice/gm)].map((match) => match[1]!).filter((key) => key !== "objects[].unit");
    expect(all.length).toBeGreaterThan(10);
    for (const key of all) {
      expect(choices(key).length, key).toBeGreaterThan(1);
      for (const choice of choices(key)) expect(valueLabel(key, choice), `${key} = ${choice}`).not.toBe(choice);
    }
  });

  it("name every key of a scene and its group", () => {
    const keys = [...keysOfDocs.matchAll(/^\| `([a-z0-9_.[\]]+)` \| (?:number|integer|flag|text|choice|vector|file|name)/gm)].map((match) => match[1]!);
    expect(keys.length).toBeGreaterThan(80);
    for (const key of keys) {
      expect(texts.settings.labels[key], key).toBeTruthy();
      expect(texts.settings.groups[groupOf(key)], key).toBeTruthy();
    }
    expect(Object.keys(texts.settings.labels).filter((key) => !keys.includes(key)), "labels of keys that are gone").toEqual([]);
  });

  it("name every size that an object may have", () => {
    const sizes = [...keysOfDocs.matchAll(/\| `objects\[\]\.(\w+)` \| (?:number|vector)/g)].map((match) => match[1]!);
    const placed = ["position_mm", "rotation_deg", "friction"]; // no sizes
    for (const size of sizes.filter((one) => !placed.includes(one))) expect(texts.object.sizes[size], size).toBeTruthy();
  });
});

describe("the texts", () => {
  it("are the same in two languages only where the list states it", () => {
    const found = languages.filter(({ texts }) => texts !== english.texts).flatMap(({ texts }) => untranslated(texts));
    expect(same.filter((text) => !found.includes(text))).toEqual([]);
  });

  it("hold all the text: the sources have none of their own", () => {
    const keys = /^(Enter|Escape|Backspace|Delete|Arrow\w+|Home|End|Space|Process|Page(Up|Down))$/; // of the keyboard
    const terms = /^(Message|Files)$/; // kinds of an MCAP record and of what is dropped
    const all = literals();
    expect(all.length).toBeGreaterThan(500);
    for (const folder of ["panels", "plots", "state", "view3d", "wire", "replay", "people", "patient", "main.ts", "recording.ts"]) expect(all.some(({ place }) => place.startsWith(folder)), folder).toBe(true);
    for (const { text, place } of all) {
      if (/[;{}=<>#]/.test(text) || keys.test(text) || terms.test(text)) continue; // shaders and the like
      expect(text, place).not.toMatch(/(^|\s)[A-Za-z]{2,} [a-z]{2,}(\s|[.,:!?…]|$)/); // a sentence
      expect(text, place).not.toMatch(/(^|\s)[A-Z][a-z]{2,}(\s|[.,:!?…]|$)/); // a label
      expect(text.trim(), place).not.toMatch(/^(N|Nm|rad|mm|cm|N\/s|Nm\/s|rad\/s|N\/mm|ms|µs|s|°|HTTP|–)$/);
      expect(text, place).not.toMatch(/^(en|de)(-[A-Z]{2})?$/); // a language, or strings.locale
    }
  });

  it("are all used", () => {
    const inHtml = ["noScript", "replay.noScript"]; // opening.test.ts
    expect(unusedTexts().filter((path) => !inHtml.includes(path))).toEqual([]);
  });
});
