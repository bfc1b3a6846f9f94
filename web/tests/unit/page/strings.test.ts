// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { ChangeKind, HandSource, KeyType, Notice_Level } from "../../../src/gen/phalanx/cockpit_pb";
import { valueLabel } from "../../../src/panels/plain_words";
import { groupOf } from "../../../src/panels/settings_list";
import { strings } from "../../../src/strings";
import { literals, unusedTexts } from "./source_texts";

const keysOfDocs = readFileSync(resolve(__dirname, "../../../../docs/scenes.md"), "utf8");

/// The choices of a key in the table of docs/scenes.md.
function choices(key: string): string[] {
  const line = keysOfDocs.split("\n").find((one) => one.startsWith(`| \`${key}\` | choice`));
  return line?.split("|")[4]?.split(",").map((word) => word.trim()) ?? [];
}

function visit(value: unknown, path: string, found: (path: string, text: string) => void): void {
  if (typeof value === "string") found(path, value);
  else if (typeof value === "function") found(path, String((value as (...words: unknown[]) => unknown)("a", "b", "c", "d", "e")));
  else if (Array.isArray(value)) value.forEach((one, i) => visit(one, `${path}[${i}]`, found));
  else for (const [name, one] of Object.entries(value as object)) visit(one, `${path}.${name}`, found);
}

const enumNames = (values: object) => Object.values(values).filter((value) => typeof value === "string").length;

describe("strings", () => {
  it("are all there, and none is blank", () => {
    let count = 0;
    visit(strings, "strings", (path, text) => {
      ++count;
      expect(text.trim(), path).not.toBe("");
      expect(text, path).not.toContain("undefined");
    });
    expect(count).toBeGreaterThan(200);
  });

  it("name every value of the messages' enumerations", () => {
    expect(strings.hand.sources.length).toBe(enumNames(HandSource));
    expect(strings.settings.change.length).toBe(enumNames(ChangeKind));
    expect(strings.settings.types.length).toBe(enumNames(KeyType));
    expect(strings.notice.levels.length).toBe(enumNames(Notice_Level));
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
      expect(strings.settings.labels[key], key).toBeTruthy();
      expect(strings.settings.groups[groupOf(key)], key).toBeTruthy();
    }
    expect(Object.keys(strings.settings.labels).filter((key) => !keys.includes(key)), "labels of keys that are gone").toEqual([]);
  });

  it("name every size that an object may have", () => {
    const sizes = [...keysOfDocs.matchAll(/\| `objects\[\]\.(\w+)` \| (?:number|vector)/g)].map((match) => match[1]!);
    const placed = ["position_mm", "rotation_deg", "friction"]; // no sizes
    for (const size of sizes.filter((one) => !placed.includes(one))) expect(strings.object.sizes[size], size).toBeTruthy();
  });

  it("hold all the text: the sources have none of their own", () => {
    const keys = /^(Enter|Escape|Backspace|Delete|Arrow\w+|Home|End|Space|Process|Page(Up|Down))$/; // of the keyboard
    const terms = /^(Message|Files)$/; // kinds of an MCAP record and of what is dropped
    const all = literals();
    expect(all.length).toBeGreaterThan(500);
    for (const folder of ["panels", "plots", "state", "view3d", "wire", "replay", "main.ts", "recording.ts"]) expect(all.some(({ place }) => place.startsWith(folder)), folder).toBe(true);
    for (const { text, place } of all) {
      if (/[;{}=<>#]/.test(text) || keys.test(text) || terms.test(text)) continue; // shaders and the like
      expect(text, place).not.toMatch(/(^|\s)[A-Za-z]{2,} [a-z]{2,}(\s|[.,:!?…]|$)/); // a sentence
      expect(text, place).not.toMatch(/(^|\s)[A-Z][a-z]{2,}(\s|[.,:!?…]|$)/); // a label
      expect(text.trim(), place).not.toMatch(/^(N|Nm|rad|mm|cm|N\/s|Nm\/s|rad\/s|N\/mm|ms|µs|s|°|HTTP|–)$/);
      expect(text, place).not.toMatch(/^en(-[A-Z]{2})?$/); // strings.locale
    }
  });

  it("are all used", () => {
    const inHtml = ["opening", "noScript", "replay.noScript"]; // opening.test.ts
    expect(unusedTexts().filter((path) => !inHtml.includes(path))).toEqual([]);
  });
});
