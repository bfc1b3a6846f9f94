// SPDX-License-Identifier: Apache-2.0
import { readdirSync, readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { faultLanguages, peopleLanguages } from "../../../src/people/words";
import { languages, strings } from "../../../src/strings";
import { en } from "../../../src/strings/people_en";

const html = readFileSync(resolve(__dirname, "../../../people.html"), "utf8");

type Text = string | ((...told: readonly string[]) => string);
const told: readonly string[] = ["21", "22", "23"];
const said = (text: Text) => (typeof text === "string" ? text : text(...told));

function all(value: object, path = ""): readonly (readonly [string, Text])[] {
  return Object.entries(value).flatMap(([name, one]: [string, unknown]) => {
    const at = path === "" ? name : `${path}.${name}`;
    return typeof one === "object" && one !== null ? all(one, at) : [[at, one as Text] as const];
  });
}

/// What is the same in English and in German.
const same: readonly string[] = ["–", "21 (22)", "21: 22"];

describe.each(Object.entries(peopleLanguages))("the texts of the page of patients in %s", (code, texts) => {
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
    for (const [path, text] of all(texts)) {
      if (typeof text === "string") continue;
      for (const word of told.slice(0, text.length)) expect(text(...told), path).toContain(word);
    }
  });
});

it("each fault of the station has words in each other language", () => {
  const source = readFileSync(resolve(__dirname, "../../../../src/device/fault.cpp"), "utf8");
  const names = [...source.matchAll(/Entry\{Fault::k\w+, "(\w+)"/g)].map((found) => found[1]!).filter((name) => name !== "none");
  expect(names.length).toBeGreaterThan(15);
  const others = languages.map(({ code }) => code).filter((code) => code !== "en");
  expect(Object.keys(faultLanguages)).toEqual(others);
  for (const code of others) expect(Object.keys(faultLanguages[code]!).sort()).toEqual([...names].sort());
});

it("the page of patients is there in each language of the cockpit", () => {
  expect(Object.keys(peopleLanguages)).toEqual(languages.map(({ code }) => code));
});

it("the page's frame stands in people.html, in English, and without scripts in every language, with no style or script that the station forbids", () => {
  const parsed = new DOMParser().parseFromString(html.replace(/<(script|link)[^>]*>/g, ""), "text/html"); // which would be fetched
  expect(parsed.documentElement.lang).toBe(strings.locale);
  expect(parsed.title).toBe(en.title);
  expect(parsed.querySelector("#page > #opening h1")!.textContent).toBe(en.heading);
  expect(parsed.querySelector("#page > #opening p")!.textContent).toBe(strings.opening);
  const without = /<noscript>(.*)<\/noscript>/.exec(html)![1]!.replace(/<[^>]*>/g, "");
  expect(without).toBe(languages.map(({ code }) => peopleLanguages[code]!.noScript).join(" "));
  expect(html).not.toMatch(/<style|style=|<script(?![^>]* src=)/);
});

it("all texts are used, and the cockpit loads none of them", () => {
  const source = resolve(__dirname, "../../../src");
  const files = readdirSync(source, { recursive: true }).map(String).filter((name) => name.endsWith(".ts") && !name.startsWith("gen/"));
  const textOf = (name: string) => readFileSync(resolve(source, name), "utf8");
  const isOwn = (name: string) => name.startsWith("people/") || name.startsWith("strings/people_");
  for (const name of files.filter((one) => !isOwn(one))) expect(textOf(name), name).not.toMatch(/from "[^"]*people(\/(?!(api|symbols)")|_(en|de))/);
  const sources = files.filter((name) => name.startsWith("people/")).map(textOf).join("\n");
  expect(sources.length).toBeGreaterThan(10_000);
  // A table is used by its name; its entries are looked up by what the station states.
  const tables = ["roles", "obstacles", "sides", "symbols", "fields", "origins", "kinds", "testSides", "exerciseKinds", "columns", "hand", "skills", "stages", "phases", "goal", "digits", "verdicts", "names"];
  const used = (path: string) => {
    const names = path.split(".");
    const table = names.findIndex((name) => tables.includes(name));
    const name = (table >= 0 ? names[table] : names.at(-1))!;
    return new RegExp(`(words|\\.|[{,] )\\b${name}\\b`).test(sources);
  };
  expect(all(en).map(([path]) => path).filter((path) => path !== "noScript" && !used(path))).toEqual([]); // noScript: in people.html
});
