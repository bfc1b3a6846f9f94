// SPDX-License-Identifier: Apache-2.0
// Values as they stand in a scene file.
import { KeyType } from "../gen/phalanx/cockpit_pb";

/// A basic string of TOML.
export function quote(text: string): string {
  let out = "";
  for (const character of text) {
    const code = character.codePointAt(0) ?? 0;
    if (character === '"' || character === "\\") out += `\\${character}`;
    else if (code < 0x20 || code === 0x7f) out += `\\u${code.toString(16).padStart(4, "0")}`;
    else out += character;
  }
  return `"${out}"`;
}

const escapes: Readonly<Record<string, string>> = { n: "\n", t: "\t", r: "\r", b: "\b", f: "\f" };

/// @returns the displayed text: a string without its quotes, anything else unchanged
export function unquote(value: string): string {
  const text = value.trim();
  if (text.length >= 2 && text.startsWith("'") && text.endsWith("'")) return text.slice(1, -1);
  if (text.length < 2 || !text.startsWith('"') || !text.endsWith('"')) return text;
  return text
    .slice(1, -1)
    .replace(/\\(u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|.)/g, (_, escape: string) =>
      escape.length > 1 ? String.fromCodePoint(parseInt(escape.slice(1), 16)) : (escapes[escape] ?? escape),
    );
}

/// A number as TOML writes it; NaN if it is none.
export function number(value: string): number {
  const text = value.trim().replaceAll("_", "");
  if (/^[+-]?inf$/.test(text)) return text.startsWith("-") ? -Infinity : Infinity;
  return /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/.test(text) ? Number(text) : NaN;
}

/// "[1, 2.5, 3]" as numbers; null if it is no such thing.
export function vector(value: string): number[] | null {
  const inside = /^\s*\[(.*)\]\s*$/s.exec(value)?.[1];
  if (inside === undefined) return null;
  const numbers = inside.split(",").map(number);
  return numbers.some(Number.isNaN) ? null : numbers;
}

/// Whether two texts say the same value: 1 and 1.0 do.
export function same(a: string, b: string): boolean {
  if (a.trim() === b.trim()) return true;
  const x = number(a);
  const y = number(b);
  if (!Number.isNaN(x) && !Number.isNaN(y)) return x === y;
  const v = vector(a);
  const w = vector(b);
  if (v && w) return v.length === w.length && v.every((value, i) => value === w[i]);
  return unquote(a) === unquote(b);
}

/// Writes numbers of controls, without digits that come from rounding.
export function fromNumber(value: number): string {
  if (value === Infinity) return "inf";
  if (value === -Infinity) return "-inf";
  return String(Number(value.toPrecision(9)));
}

/// Converts typed text to a value of a key of this type. A number may have a decimal comma; in a vector commas separate numbers.
export function fromTyped(text: string, type: KeyType): string {
  const typed = text.trim();
  const point = typed.replace(/^([^,.]*),([^,.]*)$/, "$1.$2");
  switch (type) {
    case KeyType.KEY_NUMBER:
      return point;
    case KeyType.KEY_INTEGER:
    case KeyType.KEY_FLAG:
    case KeyType.KEY_VECTOR:
      return typed;
    case KeyType.KEY_NUMBER_OR_OFF:
      return unquote(typed) === "off" ? '"off"' : point;
    default:
      return quote(unquote(typed));
  }
}

/// A table in one line: {kind = "sphere", diameter_mm = 60}.
export function table(entries: readonly (readonly [string, string])[]): string {
  return `{${entries.map(([key, value]) => `${key} = ${value}`).join(", ")}}`;
}
