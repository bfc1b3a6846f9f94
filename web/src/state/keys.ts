// SPDX-License-Identifier: Apache-2.0
// Keys of a scene: their ranges, which of them an object has, and what is in force.
import type { KeyInfo, NumberRange, Setting, State, Welcome } from "../gen/phalanx/cockpit_pb";
import { number, unquote } from "./toml";

export function within(value: number, range: NumberRange): boolean {
  if (value === -Infinity && range.minusInfinity) return true;
  if (!Number.isFinite(value)) return false;
  return (
    (range.minOpen ? value > range.min : value >= range.min) && (range.maxOpen ? value < range.max : value <= range.max)
  );
}

/// "objects[].size_mm" of the first object: "objects.0.size_mm".
export function settingOf(path: string): string {
  return path.replace("[]", ".0");
}

export function keyOf(welcome: Welcome | undefined, setting: string): KeyInfo | undefined {
  return welcome?.key.find((key) => settingOf(key.path) === setting);
}

/// @returns true if objects of this kind have the key, and for a key that is not an object's
export function belongsTo(key: KeyInfo, kind: string): boolean {
  return key.kind.length === 0 || key.kind.some((one) => one.kind === kind);
}

/// @returns the default for objects of this kind
export function defaultOf(key: KeyInfo, kind: string): string {
  return key.kind.find((one) => one.kind === kind)?.defaultValue ?? key.defaultValue;
}

export function find(settings: readonly Setting[] | undefined, key: string): string | undefined {
  return settings?.find((setting) => setting.key === key)?.value;
}

export function objectKind(state: State | undefined, welcome: Welcome | undefined): string {
  return unquote(find(state?.value, "objects.0.kind") ?? keyOf(welcome, "objects.0.kind")?.defaultValue ?? "");
}

/// @returns the value in force of a key: that of the file or of a change, otherwise its default
export function valueOf(state: State | undefined, welcome: Welcome | undefined, setting: string): string {
  const stated = find(state?.value, setting);
  if (stated !== undefined) return stated;
  const key = keyOf(welcome, setting);
  return key ? defaultOf(key, objectKind(state, welcome)) : "";
}

export const kDigitLimit = "limits.fingertip_force_n";

/// @returns a limit as a number; Infinity: it is off, or not stated
export function limitOf(value: string): number {
  const limit = number(value);
  return limit > 0 ? limit : Infinity;
}

/// Whether contacts slide, with friction.
export function slides(state: State | undefined, welcome: Welcome | undefined): boolean {
  return unquote(valueOf(state, welcome, "contact.mode")) === "sliding";
}

/// Whether another value overrides the scene's.
export function isChanged(state: State | undefined, setting: string): boolean {
  return state?.changed.some((one) => one.key === setting) ?? false;
}
