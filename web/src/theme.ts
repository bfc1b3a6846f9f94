// SPDX-License-Identifier: Apache-2.0
// Colours that mean something, in one place: for the 3D view, the plots and the style sheet. They begin with Okabe and Ito's palette. On
// white some are darker, so that a thin line of them is seen. tests/unit/page/theme.test.ts demands a contrast and a difference of the
// digits' colours, also in the sight of people with protanopia, deuteranopia and tritanopia. Each meaning has a second sign beside its colour.

export type ThemeName = "dark" | "light";

/// One a digit, thumb to little finger.
export const digitColours: Readonly<Record<ThemeName, readonly string[]>> = {
  dark: ["#E69F00", "#56B4E9", "#009E73", "#CC79A7", "#D55E00"],
  light: ["#B47D06", "#0072B2", "#00996C", "#A65580", "#A83F00"],
};

export interface Theme {
  readonly background: string;
  readonly panel: string;
  readonly text: string;
  readonly quiet: string; // labels, grid lines' text
  readonly grid: string;
  readonly accent: string; // what can be pressed
  readonly ok: string; // steady
  readonly bad: string; // shaking, fault
  readonly warn: string;
  readonly ghost: string;
  readonly table: string;
  readonly sky: string; // as shiny objects mirror it
  readonly arrow: string; // of the palm; digits have theirs
  readonly lost: string; // the hand of a page without connection
}

export const themes: Readonly<Record<ThemeName, Theme>> = {
  dark: {
    background: "#14181d",
    panel: "#1d232b",
    text: "#eef2f6",
    quiet: "#a3b0bd",
    grid: "#33404d",
    accent: "#56B4E9",
    ok: "#009E73",
    bad: "#D55E00",
    warn: "#F0E442",
    ghost: "#8fd0ff",
    table: "#4a3a2e",
    sky: "#9fb2c4",
    arrow: "#F0E442",
    lost: "#6b7076",
  },
  light: {
    background: "#f4f6f8",
    panel: "#ffffff",
    text: "#15202b",
    quiet: "#52606d",
    grid: "#ccd5de",
    accent: "#0072B2",
    ok: "#007a58",
    bad: "#b34700",
    warn: "#8a6d00",
    ghost: "#0072B2",
    table: "#d9c4a4",
    sky: "#f2f6fa",
    arrow: "#363200",
    lost: "#9a9fa5",
  },
};
