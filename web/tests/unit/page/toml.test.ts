// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { KeyType } from "../../../src/gen/phalanx/cockpit_pb";
import { fromNumber, fromTyped, number, quote, same, table, unquote, vector } from "../../../src/state/toml";
import { random } from "./random";

describe("quote", () => {
  it("escapes what a TOML string must not hold", () => {
    expect(quote('a "b" \\ c')).toBe('"a \\"b\\" \\\\ c"');
    expect(quote("line\nnext\t\u007f")).toBe('"line\\u000anext\\u0009\\u007f"');
    expect(quote("Größe ✓ 🖐")).toBe('"Größe ✓ 🖐"');
  });

  it("is undone by unquote, for any text", () => {
    const seed = 7;
    const next = random(seed);
    for (let i = 0; i < 500; ++i) {
      const text = Array.from({ length: Math.floor(next() * 12) }, () => String.fromCodePoint(Math.floor(next() * 0x250))).join("");
      expect(unquote(quote(text)), `seed ${seed}, case ${i}`).toBe(text);
    }
  });

  it("unquote leaves alone what is no string", () => {
    expect(unquote("0.5")).toBe("0.5");
    expect(unquote("'a\\b'")).toBe("a\\b");
    expect(unquote('"')).toBe('"');
  });
});

describe("numbers", () => {
  it("are read as TOML writes them", () => {
    expect(number("1_000.5")).toBe(1000.5);
    expect(number("-inf")).toBe(-Infinity);
    expect(number("1e-3")).toBe(0.001);
    for (const none of ["", "0x10", "1 2", '"off"', "1.2.3", "Infinity", "1e"]) expect(number(none), none).toBeNaN();
  });

  it("are written without digits that nobody chose", () => {
    expect(fromNumber(0.1 + 0.2)).toBe("0.3");
    expect(fromNumber(-Infinity)).toBe("-inf");
    expect(number(fromNumber(1 / 3))).toBeCloseTo(1 / 3, 9);
  });

  it("vectors are lists of numbers and nothing else", () => {
    expect(vector("[0, -1.5, 3]")).toEqual([0, -1.5, 3]);
    expect(vector("[0, a]")).toBeNull();
    expect(vector("1")).toBeNull();
  });
});

describe("same", () => {
  it("compares values, not their spelling", () => {
    expect(same("1.0", "1")).toBe(true);
    expect(same('"off"', "off")).toBe(true);
    expect(same("[1, 2, 3]", "[1.0,2,3]")).toBe(true);
    expect(same("[1, 2]", "[1, 2, 3]")).toBe(false);
    expect(same("1", "1.01")).toBe(false);
  });
});

describe("fromTyped", () => {
  it("quotes texts, and leaves numbers, flags and vectors as they are", () => {
    expect(fromTyped(" 0.9 ", KeyType.KEY_NUMBER)).toBe("0.9");
    expect(fromTyped("[1, 2, 3]", KeyType.KEY_VECTOR)).toBe("[1, 2, 3]");
    expect(fromTyped("true", KeyType.KEY_FLAG)).toBe("true");
    expect(fromTyped("hooke", KeyType.KEY_CHOICE)).toBe('"hooke"');
    expect(fromTyped('"hooke"', KeyType.KEY_CHOICE)).toBe('"hooke"');
    expect(fromTyped("off", KeyType.KEY_NUMBER_OR_OFF)).toBe('"off"');
    expect(fromTyped("3", KeyType.KEY_NUMBER_OR_OFF)).toBe("3");
  });

  it("takes a decimal comma in a number, and nowhere else", () => {
    expect(fromTyped("1,6", KeyType.KEY_NUMBER)).toBe("1.6");
    expect(fromTyped(" ,5", KeyType.KEY_NUMBER_OR_OFF)).toBe(".5");
    expect(fromTyped("1,234.5", KeyType.KEY_NUMBER)).toBe("1,234.5"); // no number: refused by the station
    expect(fromTyped("1,2,3", KeyType.KEY_NUMBER)).toBe("1,2,3");
    expect(fromTyped("[1, 2]", KeyType.KEY_VECTOR)).toBe("[1, 2]");
    expect(fromTyped("a, b", KeyType.KEY_TEXT)).toBe('"a, b"');
  });

  it("a table is one line", () => {
    expect(table([["kind", '"sphere"'], ["diameter_mm", "60"]])).toBe('{kind = "sphere", diameter_mm = 60}');
  });
});
