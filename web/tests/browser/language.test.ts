// SPDX-License-Identifier: Apache-2.0
// The page in another language: it is chosen under People, the page opens again in it as the same page, and Stop is where it was.
import { beforeAll, describe, expect, it } from "vitest";
import { english, languages, type Language } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { placeOfStop } from "./support/layout";
import { stage, unseen } from "./support/stage";
import { until } from "./support/until";

const german = languages.find(({ code }) => code === "de")!;
const wide = { width: 1366, height: 768 };
const narrow = { width: 1000, height: 640 }; // the top line has no marks
const play = stage();
let cockpit: CockpitPage;
let place: readonly number[]; // of Stop, on the English page

beforeAll(async () => {
  const station = await play.station("grasp_teapot", { "motion.hold_s": "600" });
  cockpit = await play.open(station.url, { ...unseen, viewport: wide, locale: german.texts.locale });
  await cockpit.untilRunning();
  place = await cockpit.page.evaluate(placeOfStop);
});

/// Chooses a language under People, and waits for the page in it.
async function choose(language: Language): Promise<void> {
  await cockpit.tab("people");
  await cockpit.choose(cockpit.texts.language.label, language.code);
  await cockpit.page.locator(`html[lang="${language.texts.locale}"]`).waitFor();
  cockpit.texts = language.texts;
  await cockpit.ready();
}

const mark = () => cockpit.page.getByRole("banner").getByText(german.texts.language.unreviewed, { exact: true });

describe("the language", () => {
  it("is English also in a German browser", async () => {
    expect(await cockpit.page.evaluate(() => navigator.language)).toBe(german.texts.locale);
    expect(await cockpit.page.locator("html").getAttribute("lang")).toBe(english.texts.locale);
    expect(await cockpit.page.getByRole("tab", { name: english.texts.tabs.people, exact: true }).count()).toBe(1);
    expect(await mark().count()).toBe(0);
  });

  it("is German when it has been chosen, on the same page with the same role", async () => {
    const number = await cockpit.number();
    await choose(german);
    expect(await cockpit.number()).toBe(number);
    await until("the page may change values", () => cockpit.stiffnessField.isEnabled(), () => cockpit.brief());
    for (const name of ["touch", "expert", "device", "people"] as const) await cockpit.tab(name);
    const people = await cockpit.page.getByRole("tabpanel").innerText();
    expect(people).toContain(german.texts.language.unreviewedHint);
    expect(people).toContain(german.texts.language.stationHint);
    await cockpit.tab("touch");
  });

  it("is marked as unreviewed where there is room", async () => {
    expect(await mark().isVisible()).toBe(true);
    expect(await mark().getAttribute("title")).toBe(german.texts.language.unreviewedHint);
    await cockpit.page.setViewportSize(narrow);
    expect(await mark().isVisible()).toBe(false);
    await cockpit.page.setViewportSize(wide);
  });

  it("leaves Stop where it was, and working", async () => {
    expect(await cockpit.page.evaluate(placeOfStop)).toEqual(place);
    await cockpit.untilRunning();
    await cockpit.stopButton.click();
    await cockpit.untilStopped();
    await until("the page says stopped", async () => (await cockpit.stopBox.textContent())?.includes(german.texts.safety.stopped), () => cockpit.brief());
    expect(await cockpit.page.evaluate(placeOfStop)).toEqual(place);
    await cockpit.button(german.texts.stop.resume).click();
    await cockpit.untilState("resumed", (state) => !state.heldStopped);
  });

  it("is that of the recordings, too", async () => {
    const recordings = await cockpit.page.context().newPage();
    await recordings.goto(new URL("recording.html", cockpit.page.url()).href);
    await recordings.getByRole("heading", { name: german.texts.replay.station, exact: true }).waitFor();
    expect(await recordings.locator("html").getAttribute("lang")).toBe(german.texts.locale);
    expect(await recordings.getByText(german.texts.language.unreviewed, { exact: true }).isVisible()).toBe(true);
    await recordings.close();
  });

  it("is English again when that has been chosen", async () => {
    await choose(english);
    expect(await mark().count()).toBe(0);
    expect(await cockpit.page.evaluate(placeOfStop)).toEqual(place);
  });
});
