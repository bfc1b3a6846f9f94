// SPDX-License-Identifier: Apache-2.0
// Keys of a scene: their ranges, which of them an object has, and what is in force.
import type { KeyInfo, Setting, State, Welcome } from "../gen/phalanx/cockpit_pb";
import { number, unquote } from "./toml";

export interface Range {
  readonly min: number;
  readonly max: number;
  readonly minOpen: boolean; // the bound itself is outside
  readonly maxOpen: boolean;
  readonly words: readonly string[]; // what may stand there instead of a number: off, -inf
}

/// Of KeyInfo.range: ">= -1000000, < 0, or -inf", "> 0, <= 15, or \"off\"".
export function parseRange(range: string): Range {
  let min = -Infinity;
  let max = Infinity;
  let minOpen = false;
  let maxOpen = false;
  const words: string[] = [];
  for (const part of range.split(",").map((text) => text.trim())) {
    const bound = /^(>=|<=|>|<)\s*(\S+)$/.exec(part);
    if (bound) {
      const value = number(bound[2] ?? "");
      if (Number.isNaN(value)) continue;
      if (bound[1]?.startsWith(">")) {
        min = value;
        minOpen = bound[1] === ">";
      } else {
        max = value;
        maxOpen = bound[1] === "<";
      }
    } else if (part.startsWith("or ")) {
      words.push(unquote(part.slice(3)));
    }
  }
  return { min, max, minOpen, maxOpen, words };
}

export function within(value: number, range: Range): boolean {
  if (Number.isNaN(value)) return false;
  return (
    (range.minOpen ? value > range.min : value >= range.min) && (range.maxOpen ? value < range.max : value <= range.max)
  );
}

/// The choices of a key of type "choice".
export function choicesOf(key: KeyInfo): string[] {
  return key.range
    .split(",")
    .map((text) => unquote(text))
    .filter((text) => text !== "");
}

/// "objects[].size_mm" of the first object: "objects.0.size_mm".
export function settingOf(path: string): string {
  return path.replace("[]", ".0");
}

export function keyOf(welcome: Welcome | undefined, setting: string): KeyInfo | undefined {
  return welcome?.key.find((key) => settingOf(key.path) === setting);
}

/// The kinds of object that have a key: the words in brackets that its meaning begins with; null: all of them.
export function kindsOf(key: KeyInfo, kinds: readonly string[]): string[] | null {
  if (!key.path.startsWith("objects[].")) return null;
  const words = /^\(([a-z_ ]+)\)/.exec(key.meaning)?.[1]?.split(" ") ?? [];
  return words.length > 0 && words.every((word) => kinds.includes(word)) ? words : null;
}

/// A default that depends on the object's kind, from the meaning: "...; default of bottle 65, cup 75".
export function defaultOf(key: KeyInfo, kind: string): string {
  const own = /default of (.+)$/.exec(key.meaning)?.[1] ?? "";
  const found = new RegExp(`(?:^|, )${kind} (\\[[^\\]]*\\]|[^,;]+)`).exec(own)?.[1];
  return found?.trim() ?? key.defaultValue;
}

export function find(settings: readonly Setting[] | undefined, key: string): string | undefined {
  return settings?.find((setting) => setting.key === key)?.value;
}

export function objectKind(state: State | undefined, welcome: Welcome | undefined): string {
  return unquote(find(state?.value, "objects.0.kind") ?? keyOf(welcome, "objects.0.kind")?.defaultValue ?? "");
}

/// What is in force for a key: what the file or a change states, else its default.
export function valueOf(state: State | undefined, welcome: Welcome | undefined, setting: string): string {
  const stated = find(state?.value, setting);
  if (stated !== undefined) return stated;
  const key = keyOf(welcome, setting);
  return key ? defaultOf(key, objectKind(state, welcome)) : "";
}

/// Whether somebody laid another value over the scene's.
export function isChanged(state: State | undefined, setting: string): boolean {
  return state?.changed.some((one) => one.key === setting) ?? false;
}
