// SPDX-License-Identifier: Apache-2.0
// The choice of the page's language. The browser remembers it, and the page opens again in it, with its role. A language that no native
// speaker has reviewed is marked.
import { english, kLanguageKey, language, languages, strings, type Language } from "../strings";
import { lasting } from "../wire/memory";
import type { App } from "./app";
import { ChoiceBox } from "./choice_box";
import { el, setShown } from "./dom";
import { row } from "./setting_controls";

const words = strings.language;

/// In the language itself.
function nameOf({ texts, reviewed }: Language): string {
  return reviewed ? texts.language.name : texts.language.unreviewedName(texts.language.name);
}

/// @param reload  opens the page again
export function languageChoice(app: App, reload: () => void = () => location.reload()): HTMLElement {
  const box = new ChoiceBox(() => choose());
  const made = row(words.label, box);
  box.setChoices(languages.map((one) => ({ value: one.code, text: nameOf(one) })));
  box.value = language.code;
  function choose(): void {
    if (lasting.set(kLanguageKey, box.value)) return reload();
    box.value = language.code;
    made.refuse(words.notKept);
  }
  const notes = [language.reviewed ? "" : words.unreviewedHint, language === english ? "" : words.stationHint].filter((note) => note !== "");
  const hint = el("p", { class: "hint" }, notes.join(" "));
  setShown(hint, notes.length > 0);
  // Without a connection there may be no station to load the page from, and with the page Stop would be gone.
  const update = () => (box.button.disabled = !app.store.connected);
  app.store.on(["connection"], update);
  update();
  return el("div", {}, made.element, hint);
}

/// Marks a page in a language that has not been reviewed; null: it has been.
export function unreviewedMark(): HTMLElement | null {
  return language.reviewed ? null : el("span", { class: "chip", title: words.unreviewedHint }, words.unreviewed);
}
