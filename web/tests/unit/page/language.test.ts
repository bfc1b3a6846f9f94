// SPDX-License-Identifier: Apache-2.0
// Which language the page is in, and the choice of another.
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { english, kLanguageKey, languages } from "../../../src/strings";
import { fakeApp } from "./fake_app";

const german = languages.find(({ code }) => code === "de")!;

/// The modules of a page that is opened now.
async function opened() {
  vi.resetModules();
  return { ...(await import("../../../src/strings")), ...(await import("../../../src/panels/language_choice")) };
}

const remember = (code: string) => localStorage.setItem(kLanguageKey, code);
beforeEach(() => localStorage.clear());
afterEach(() => {
  vi.unstubAllGlobals();
  localStorage.clear();
  vi.resetModules(); // the next module that reads the language finds no choice
});

describe("the language", () => {
  it.each(["", "xx", "DE", "Deutsch", "constructor"])("is English where the browser remembers %j", async (code) => {
    remember(code);
    expect((await opened()).language.code).toBe("en");
  });

  it("is English in a German browser until German is chosen", async () => {
    vi.stubGlobal("navigator", { language: german.texts.locale, languages: [german.texts.locale] });
    expect((await opened()).language.code).toBe("en");
  });

  it("is English where there is no memory, as in a worker", async () => {
    vi.stubGlobal("localStorage", undefined);
    expect((await opened()).language.code).toBe("en");
  });

  it.each(languages)("is $code where the browser remembers it", async ({ code, texts }) => {
    remember(code);
    const { language, strings } = await opened();
    expect(language.code).toBe(code);
    expect(strings.language.name).toBe(texts.language.name);
  });
});

describe("the choice", () => {
  const remembered: (string | null)[] = []; // when the page opened again
  const reload = () => void remembered.push(localStorage.getItem(kLanguageKey));
  beforeEach(() => void (remembered.length = 0));

  async function shown(app = fakeApp().app) {
    const { languageChoice } = await opened();
    const element = languageChoice(app, reload);
    const button = element.querySelector("button")!;
    const options = [...element.querySelectorAll<HTMLElement>("[role=option]")];
    return { element, button, options, choose: (code: string) => (button.click(), options.find((one) => one.dataset["value"] === code)!.click()) };
  }

  it("offers each language by its own name, and says which are unreviewed", async () => {
    const { options, button } = await shown();
    expect(button.textContent).toBe(english.texts.language.name);
    expect(options.length).toBe(languages.length);
    languages.forEach(({ texts, reviewed }, i) => {
      expect(options[i]!.textContent).toContain(texts.language.name);
      expect(options[i]!.textContent!.includes(texts.language.unreviewed)).toBe(!reviewed);
    });
  });

  it("is remembered before the page opens again", async () => {
    (await shown()).choose("de");
    expect(remembered).toEqual(["de"]);
    expect((await opened()).language.code).toBe("de");
    (await shown()).choose("de"); // it is in force
    expect(remembered).toEqual(["de"]);
    (await shown()).choose("en");
    expect(remembered).toEqual(["de", "en"]);
  });

  it("states that the browser keeps nothing, and leaves the page alone", async () => {
    const { element, button, choose } = await shown();
    vi.stubGlobal("localStorage", { setItem: () => {}, getItem: () => null });
    choose("de");
    expect(remembered).toEqual([]);
    expect(element.querySelector("[role=alert]")!.textContent).toBe(english.texts.language.notKept);
    expect(button.textContent).toBe(english.texts.language.name);
  });

  it("waits for a connection: without a station the page could not open again, and Stop would be gone", async () => {
    const { app, store } = fakeApp();
    const { button } = await shown(app);
    expect(button.disabled).toBe(false);
    store.setPhase("waiting");
    expect(button.disabled).toBe(true);
    store.setPhase("open");
    expect(button.disabled).toBe(false);
  });
});

describe("an unreviewed language", () => {
  it("is marked, and the choice states it with what stays English", async () => {
    remember("de");
    const { unreviewedMark, languageChoice } = await opened();
    const words = german.texts.language;
    expect(unreviewedMark()!.textContent).toBe(words.unreviewed);
    expect(unreviewedMark()!.getAttribute("title")).toBe(words.unreviewedHint);
    const hint = languageChoice(fakeApp().app).querySelector<HTMLElement>(".hint")!;
    expect(hint.hidden).toBe(false);
    expect(hint.textContent).toContain(words.unreviewedHint);
    expect(hint.textContent).toContain(words.stationHint);
  });

  it("is no matter of an English page", async () => {
    const { unreviewedMark, languageChoice } = await opened();
    expect(unreviewedMark()).toBeNull();
    expect(languageChoice(fakeApp().app).querySelector<HTMLElement>(".hint")!.hidden).toBe(true);
  });
});
