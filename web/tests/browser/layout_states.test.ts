// SPDX-License-Identifier: Apache-2.0
// Every state of the page at every size of screen, and in other languages those with most text at some sizes: nothing lies over anything,
// nothing is cut off, and Stop stands still.
import type { Server } from "node:http";
import { chromium, type Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, inject, it } from "vitest";
import { english, languages, type Language } from "../../src/strings";
import { FakeHost, serveSite } from "./fake_host";
import { faultsOfLayout, kSizes, overlappingTexts, placeOfStop } from "./support/layout";
import { rememberLanguage } from "./support/page_language";
import { pageStates, type PageState } from "./support/page_states";
import { paintNothing } from "./support/slow_screen";
import { until } from "./support/until";

let browser: Browser;
let site: { readonly server: Server; readonly url: string };
const places = new Map<string, readonly number[]>(); // of Stop, by size and type, in the first state; the same in every language

beforeAll(async () => {
  site = await serveSite();
  browser = await chromium.connect(inject("browser"));
});
afterAll(async () => {
  await browser?.close();
  site?.server.close();
});

// A state that is there for another size or theme has the layout of one that is listed as well.
const states = pageStates.filter(({ again }) => !again);
const wordy: readonly string[] = ["shaking", "fault", "silent", "lost_stop", "viewer", "take", "sliders", "device", "calibration_ask", "people", "upload_bad", "expert"];
const kUsual: typeof kSizes = [[1366, 768], [1024, 768], [390, 844]];

interface Run extends PageState {
  readonly language: Language;
  readonly sizes: typeof kSizes;
}
const runs: readonly Run[] = languages.flatMap((language) =>
  language === english
    ? states.map((state) => ({ ...state, language, sizes: kSizes }))
    : states.filter(({ name }) => wordy.includes(name)).map((state) => ({ ...state, language, sizes: kUsual })));

it("the states with most text are there", () => expect(wordy.filter((name) => !states.some((state) => state.name === name))).toEqual([]));

describe.each(runs)("$name, $language.code", ({ name, before, act, language, sizes }) => {
  it("is whole at every size", async () => {
    const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, deviceScaleFactor: 0.5 });
    await rememberLanguage(context, language);
    const page = await context.newPage();
    await page.addInitScript(paintNothing);
    const errors: string[] = [];
    page.on("pageerror", (error) => errors.push(String(error)));
    const host = new FakeHost();
    before?.(host);
    await host.attach(page);
    await page.goto(site.url);
    await until("a picture", () => page.evaluate(() => (window.phalanx?.view()?.frames ?? 0) > 2 && document.querySelector(".plots") !== null));
    await act?.(page, host, language.texts);
    for (const [width, height] of sizes) {
      await page.setViewportSize({ width, height });
      const what = `${name}, ${language.code}, at ${width} x ${height}`;
      expect.soft(await page.evaluate(faultsOfLayout), what).toEqual([]);
      expect.soft(await page.evaluate(overlappingTexts), what).toEqual([]);
      const place = await page.evaluate(placeOfStop);
      const size = `${width} x ${height}${name === "large" ? ", large type" : ""}`;
      if (!places.has(size)) places.set(size, place);
      expect.soft(place, `${what}: Stop moved`).toEqual(places.get(size));
    }
    expect(errors).toEqual([]);
    host.hush();
    await context.close();
  });
});
