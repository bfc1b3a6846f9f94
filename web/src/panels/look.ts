// SPDX-License-Identifier: Apache-2.0
// Dark or light, and the size of type. The system's wish until the person has chosen.
import { digitColours, themes, type ThemeName } from "../theme";
import { lasting } from "../wire/memory";

const kTheme = "phalanx.theme";
const kLarge = "phalanx.large";

export class Look {
  private name: ThemeName;
  private isLarge = lasting.get(kLarge) === "yes";

  constructor(private readonly changed: (theme: ThemeName) => void) {
    const wish = window.matchMedia("(prefers-color-scheme: light)");
    const stored = lasting.get(kTheme);
    this.name = stored === "dark" || stored === "light" ? stored : wish.matches ? "light" : "dark";
    wish.addEventListener("change", () => {
      if (lasting.get(kTheme) === "") this.apply(wish.matches ? "light" : "dark");
    });
    this.apply(this.name);
  }

  get theme(): ThemeName {
    return this.name;
  }

  get large(): boolean {
    return this.isLarge;
  }

  setTheme(theme: ThemeName): void {
    lasting.set(kTheme, theme);
    this.apply(theme);
  }

  setLarge(large: boolean): void {
    lasting.set(kLarge, large ? "yes" : "");
    this.isLarge = large;
    this.apply(this.name);
  }

  private apply(theme: ThemeName): void {
    this.name = theme;
    const root = document.documentElement;
    root.dataset["theme"] = theme;
    root.dataset["large"] = String(this.isLarge);
    for (const [colour, value] of Object.entries(themes[theme])) root.style.setProperty(`--${colour}`, String(value));
    digitColours[theme].forEach((colour, digit) => root.style.setProperty(`--digit-${digit}`, colour));
    this.changed(theme);
  }
}
