// SPDX-License-Identifier: Apache-2.0
// Dark or light, and the size of type. The system's wish until the person has chosen.
import { digitColours, themes, type ThemeName } from "../theme";
import { strings } from "../strings";
import { lasting } from "../wire/memory";
import { setSwitch, switchButton } from "./dom";

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

/// The switches of a page's header. `update` shows a theme that was changed elsewhere.
export function lookSwitches(look: Look): { readonly elements: readonly HTMLElement[]; update(): void } {
  const light = switchButton(strings.look.light, (on) => {
    look.setTheme(on ? "light" : "dark");
    setSwitch(light, on);
  });
  const large = switchButton(strings.look.large, (on) => {
    look.setLarge(on);
    setSwitch(large, on);
  });
  setSwitch(large, look.large);
  const update = () => setSwitch(light, look.theme === "light");
  update();
  return { elements: [light, large], update };
}
