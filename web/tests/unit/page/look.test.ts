// SPDX-License-Identifier: Apache-2.0
import { beforeEach, expect, it } from "vitest";
import { Look } from "../../../src/panels/look";
import { digitColours, themes, type ThemeName } from "../../../src/theme";

beforeEach(() => localStorage.clear());

it("the style sheet gets the theme's colours, the digits' included", () => {
  const seen: ThemeName[] = [];
  const look = new Look((theme) => seen.push(theme));
  const root = document.documentElement;
  for (const theme of ["light", "dark"] as const) {
    look.setTheme(theme);
    expect(root.dataset["theme"]).toBe(theme);
    expect(root.style.getPropertyValue("--panel")).toBe(themes[theme].panel);
    digitColours[theme].forEach((colour, digit) => expect(root.style.getPropertyValue(`--digit-${digit}`)).toBe(colour));
    expect(new Look(() => {}).theme).toBe(theme);
  }
  expect(seen.slice(1)).toEqual(["light", "dark"]);
});
