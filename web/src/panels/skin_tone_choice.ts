// SPDX-License-Identifier: Apache-2.0
// The choice of the shown hand's skin tone. The browser remembers it.
import { strings } from "../strings";
import { kSkinTones, kUsualTone, skinTones, type SkinToneName } from "../view3d/skin_tones";
import { lasting } from "../wire/memory";
import { button, el, setAttribute } from "./dom";

const kKey = "phalanx.skin";
const words = strings.view;

export interface SkinToneChoice {
  readonly element: HTMLElement;
  readonly tone: SkinToneName;
}

export function skinToneChoice(chosen: (tone: SkinToneName) => void): SkinToneChoice {
  const stored = lasting.get(kKey);
  let tone = kSkinTones.find((name) => name === stored) ?? kUsualTone;
  const choices = kSkinTones.map((name) => {
    const control = button("", () => choose(name), { role: "radio", class: "skin-tone", "aria-label": words.skinTones[name], title: words.skinTones[name] });
    control.style.background = skinTones[name].skin;
    return { name, control };
  });
  const mark = () => choices.forEach(({ name, control }) => setAttribute(control, "aria-checked", String(name === tone)));
  function choose(name: SkinToneName): void {
    tone = name;
    lasting.set(kKey, name);
    mark();
    chosen(name);
  }
  mark();
  const row = el("div", { class: "skin-tones", role: "radiogroup", "aria-label": words.skinTone }, ...choices.map(({ control }) => control));
  return {
    element: el("div", { class: "view-choice" }, el("span", { "aria-hidden": "true" }, words.skinTone), row),
    get tone() {
      return tone;
    },
  };
}
