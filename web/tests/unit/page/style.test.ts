// SPDX-License-Identifier: Apache-2.0
// What only a style sheet says. How it looks is asserted and pictured in tests/browser.
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { describe, expect, it } from "vitest";
import { strings } from "../../../src/strings";

const sheet = (name: string) => readFileSync(resolve(__dirname, `../../../src/style/${name}.css`), "utf8");

describe("the style sheets", () => {
  it("give each verdict a lamp of its own shape", () => {
    const { label: _label, shakesFull: _full, none: _plain, ...others } = strings.verdict;
    const looks = Object.keys(others).map((verdict) => new RegExp(`\\.verdict\\[data-verdict="${verdict}"\\] \\.lamp \\{([^}]*)\\}`).exec(sheet("view"))?.[1]);
    expect(looks.length).toBe(4);
    for (const look of looks) expect(look).toMatch(/background: (linear-gradient|var|#)/);
    expect(new Set(looks).size).toBe(looks.length);
  });

  it("take the digits' colours from the theme", () => {
    strings.digits.forEach((_, digit) => expect(sheet("base")).toMatch(new RegExp(`\\[data-digit="${digit}"\\] \\{\\s*--digit: var\\(--digit-${digit}\\);`)));
  });
});
