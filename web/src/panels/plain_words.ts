// SPDX-License-Identifier: Apache-2.0
// The station's texts in the words of the page: labels in place of keys and codes, names in place of addresses, files without their folders.
import { strings } from "../strings";

const words = strings.settings;

/// Labels of the choices of keys.
const choices: Readonly<Record<string, Readonly<Record<string, string>>>> = {
  ...words.choices,
  "force.law": strings.force.laws,
  "stabiliser.method": strings.calm.methods,
  "grasp.type": strings.grasp.types,
  "objects[]": strings.object.kinds, // a whole object is named by its kind
  "objects[].kind": strings.object.kinds,
  "objects[].unit": strings.object.units,
  "hand.side": { right: strings.hand.right, left: strings.hand.left },
};

const pathOf = (key: string) => key.replace(/^objects\.\d+(?=\.|$)/, "objects[]");

/// @param key  "force.law", "objects[].kind" or "objects.0.kind"  @returns its label; a key without a label stays as it is
export function settingLabel(key: string): string {
  const path = pathOf(key);
  return path === "objects[]" ? words.groups["objects"]! : (words.labels[path] ?? key);
}

/// @param value  without quotation marks  @returns the label of a choice or a flag; another value stays as it is
export function valueLabel(key: string, value: string): string {
  if (value === "true") return words.on;
  return value === "false" ? words.off : (choices[pathOf(key)]?.[value] ?? value);
}

// force.law, also with its value if that is one word; neither grasp.toml in a path nor example.org/x
const kSetting = /(?<![\w./-])([a-z]+(?:\.(?:\d+\.)?[a-z0-9_]+)+)(?![\w/.-]*\w)(?: = (?:"([a-z0-9_]+)"|([a-z_]+)(?![\w."])))?/g;
const kPartOfObject = /(?<=, )([a-z_]+)(?= [-\d[])/g; // objects.0 = sphere, diameter_mm 60
const kFolders = /(?<![\w:/])(?:[\w.~-]*\/)+([\w.-]+\.\w+)/g;
const kAddressOfPage = /\b(page(?: \d+)?) \([\da-f.:]+(?:%\w+)?\)/gi;

function settingWords(whole: string, key: string, quoted?: string, bare?: string): string {
  const label = settingLabel(key);
  if (label === key) return whole;
  const value = quoted ?? bare;
  const shown = value === undefined ? value : valueLabel(key, value);
  if (shown === undefined || shown === value) return strings.quoted(label) + whole.slice(key.length);
  return words.is(strings.quoted(label), shown);
}

/// @returns the text with labels for keys (in quotation marks) and choices, pages without addresses, and the last part of each path of a file
export function plainWords(text: string): string {
  return text
    .replace(kSetting, settingWords)
    .replace(kPartOfObject, (name) => words.labels[`objects[].${name}`] ?? name)
    .replace(kFolders, "$1")
    .replace(kAddressOfPage, "$1");
}

/// @returns what happened, in the page's words; a marker has the words of the person who set it
export const eventWords = (code: string, text: string) => (code === "marker" ? text : plainWords(text));

/// @param name  that its person has given; empty: none
export const pageName = (number: number, name: string) => (name === "" ? strings.page(number) : strings.namedPage(name, strings.page(number)));

const kPage = /^page (\d+)(?: \([^)]*\))?(?:, (.*))?$/;
const kAddress = /^[\da-f]*[.:][\da-f.:]*(?:%\w+)?$/i;

/// @param who  did something, as the station states it: "page 2 (127.0.0.1), Anna"; empty: the station  @param own  number of this page
export function whoText(who: string, own?: number): string {
  if (who === "") return strings.people.station;
  if (kAddress.test(who)) return strings.people.program;
  const page = kPage.exec(who);
  if (!page) return plainWords(who);
  const number = Number(page[1]);
  return number === own ? strings.me : pageName(number, page[2] ?? "");
}
