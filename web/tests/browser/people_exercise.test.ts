// SPDX-License-Identifier: Apache-2.0
// The therapist's way against the program: from an empty system to the first repetition of a simulated patient, a reload, a pause and STOP in
// the middle, the result, the report and the export.
import { beforeAll, describe, expect, it } from "vitest";
import type { Download, Locator } from "playwright-core";
import { en } from "../../src/strings/people_en";
import { allRules, bringAxe, violations } from "./support/axe";
import type { PatientsPage } from "./support/patients_page";
import { stage, unseen, type OwnStation } from "./support/stage";
import { until } from "./support/until";

const kMostTaps = 12;
const kMostTabs = 150; // through the whole page
const kCode = "SIM1";

const play = stage();
let station: OwnStation;
let patients: PatientsPage;
let taps = 0;

async function tap(found: Locator): Promise<void> {
  ++taps;
  await found.click();
}
async function expectNoViolations(what: string): Promise<void> {
  expect(await violations(patients.page, allRules), what).toEqual([]);
}
const panel = () => patients.page.getByRole("region", { name: en.run.region(kCode), exact: true });
/// A button that takes a press now.
const ready = (name: string) => patients.page.locator('.run-buttons button[aria-disabled="false"]', { hasText: name });
const trial = () => panel().getByText(/^Trial \d of 3/).first();

/// Presses Tab until a button has the focus, and then Enter. Wherever the focus is on its way, it is in sight and marked.
async function byKeyboard(name: string): Promise<void> {
  await patients.page.getByRole("button", { name }).first().waitFor();
  for (let tabs = 0; tabs < kMostTabs; ++tabs) {
    await patients.page.keyboard.press("Tab");
    const at = await patients.page.evaluate(() => {
      const focused = document.activeElement;
      if (!(focused instanceof HTMLElement) || focused === document.body) return undefined; // between the page's end and its beginning
      const { width, height, top, bottom } = focused.getBoundingClientRect();
      const { outlineStyle, visibility } = getComputedStyle(focused);
      return { name: focused.getAttribute("aria-label") ?? focused.textContent ?? "", seen: width > 0 && height > 0 && bottom > 0 && top < innerHeight && visibility === "visible", marked: outlineStyle !== "none", disabled: focused.hasAttribute("disabled") };
    });
    if (!at) continue;
    expect([at.seen, at.marked], at.name).toEqual([true, true]);
    if (at.name.startsWith(name)) return patients.page.keyboard.press("Enter");
  }
  throw new Error(`Tab leads to no button “${name}”`);
}

beforeAll(async () => {
  station = await play.ownStation(["first_touch", "--data", "data", "--keys", "config/keys"]);
  patients = await play.openPatients(station.url, unseen);
  await patients.page.getByText(en.signIn.owner).waitFor();
  await bringAxe(patients.page);
});

describe("the therapist's way", () => {
  it(`leads from an empty system to the first repetition in at most ${kMostTaps} taps`, async () => {
    await tap(patients.button(en.list.add));
    await patients.page.keyboard.type(kCode); // the field has the focus
    await tap(patients.page.getByRole("radio", { name: en.sides["right"]! }));
    await tap(patients.page.getByRole("switch", { name: en.fields["consent"]! }));
    await tap(patients.page.getByRole("radio", { name: en.templates.names["assessment_day"]! }));
    await tap(patients.button(en.save));
    await patients.patient(kCode).waitFor();
    await expectNoViolations("a patient with a prescription");
    await tap(patients.page.getByRole("button", { name: `${en.begin.begin}: Entry check` }));
    await expectNoViolations("the confirmation");
    await tap(patients.button(en.begin.confirm(kCode, en.sides["right"]!)));
    await tap(patients.button(en.run.start));
    await tap(ready(en.run.skip)); // it takes no press just after a phase has changed
    await trial().waitFor(); // a simulated participant gives the ratings itself
    await expectNoViolations("an exercise that runs");
    console.log(`from an empty system to the first repetition: ${taps} taps`);
    expect(taps).toBeLessThanOrEqual(kMostTaps);
  });

  it("leads back to the exercise after a reload", async () => {
    await patients.page.reload();
    await panel().waitFor();
    await bringAxe(patients.page);
  });

  it("pauses, stops with STOP, and goes on", async () => {
    await patients.button(en.run.pause).click();
    await patients.button(en.run.resume).click();
    await patients.button(en.run.pause).waitFor();
    await patients.stopButton.click();
    await panel().getByText(en.run.forcesOff).waitFor();
    await expectNoViolations("a pause with forces off");
    await patients.button(en.run.resume).click();
    await patients.button(en.run.pause).waitFor();
  });

  it("ends with a result, which the course of the patient has, too", async () => {
    await patients.button(en.run.end).click();
    await patients.button(en.run.endYes).click();
    await panel().getByText(en.run.interrupted).waitFor();
    await expectNoViolations("a result");
    await patients.button(en.run.back(kCode)).click();
    await patients.patient(kCode).getByText(en.results.interrupted).waitFor();
  });

  it("exports three files, and opens the report in a window of its own, which a lock closes", async () => {
    const saved: Download[] = [];
    patients.page.on("download", (one) => saved.push(one));
    await patients.button(en.documents.export).click();
    await patients.page.getByText(en.documents.saved("").trim()).waitFor();
    await until("three files", () => saved.length === 3);
    expect(saved.map((one) => one.suggestedFilename()).sort()).toEqual([`${kCode}-patient.json`, `${kCode}-results.csv`, `${kCode}-tests.csv`]);
    const [report] = await Promise.all([patients.page.waitForEvent("popup"), patients.button(en.documents.report).click()]);
    await report.getByText(kCode).first().waitFor();
    expect(await report.evaluate(() => document.adoptedStyleSheets.reduce((sum, sheet) => sum + sheet.cssRules.length, 0)), "the report has its styles").toBeGreaterThan(0);
    const closed = report.waitForEvent("close");
    await patients.button(en.lock.now).click();
    await closed;
    expect(await patients.html()).not.toContain(kCode);
  });

  it("is walked with the keyboard alone, from the lock to a finished exercise", async () => {
    await byKeyboard(en.lock.goOn);
    await byKeyboard(kCode);
    await patients.patient(kCode).waitFor();
    await byKeyboard(`${en.begin.begin}: Entry check`);
    await byKeyboard(en.begin.confirm(kCode, en.sides["right"]!));
    await byKeyboard(en.run.start);
    await byKeyboard(en.run.pause);
    await until("a resume that takes a press", () => patients.button(en.run.resume).isEnabled()); // it takes none just after a pause
    await byKeyboard(en.run.resume);
    await byKeyboard(en.run.end);
    await byKeyboard(en.run.endYes);
    await panel().getByText(en.run.interrupted).waitFor();
    await byKeyboard(en.run.back(kCode));
    await patients.patient(kCode).waitFor();
  });
});
