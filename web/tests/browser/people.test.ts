// SPDX-License-Identifier: Apache-2.0
// The page of patients against the program: the owner of the computer adds a patient, changes it, locks the page, and stops the device.
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import { en } from "../../src/strings/people_en";
import { allRules, bringAxe, violations } from "./support/axe";
import type { CockpitPage } from "./support/cockpit_page";
import type { PatientsPage } from "./support/patients_page";
import { stage, unseen, type OwnStation } from "./support/stage";

const play = stage();
let station: OwnStation;
let cockpit: CockpitPage;
let patients: PatientsPage;

async function expectNoViolations(what: string): Promise<void> {
  expect(await violations(patients.page, allRules), what).toEqual([]);
}

beforeAll(async () => {
  station = await play.ownStation(["first_touch", "--data", "data", "--keys", "config/keys"]);
  cockpit = await play.open(station.url, unseen);
  await cockpit.untilRunning();
  patients = await play.openPatients(station.url, unseen);
  await patients.page.getByText(en.signIn.owner).waitFor();
  await bringAxe(patients.page);
});

describe("the page of patients", () => {
  it("signs the owner of this computer in without a password, and lists nothing yet", async () => {
    await patients.page.getByText(en.list.none).waitFor();
    expect(await patients.page.locator("input[type=password]").count()).toBe(0);
    await expectNoViolations("an empty list");
  });

  it("adds a patient, for whom a side must be chosen", async () => {
    await patients.button(en.list.add).click();
    await expectNoViolations("the form of a new patient");
    await patients.fieldLike(en.fields["code"]!).fill("P07");
    await patients.button(en.save).click();
    await patients.page.getByText(en.patient.noSide).waitFor();
    await patients.button(en.cancel).click();
    await patients.add("P07", "left");
    await patients.listed("P07").waitFor();
    expect(await patients.patient("P07").innerText()).toContain(en.obstacles["unchecked"]);
    await expectNoViolations("a patient");
  });

  it("changes a field, and refuses a change of what another page changed meanwhile", async () => {
    await patients.button(en.patient.edit).click();
    await expectNoViolations("the form of a patient");
    const other = await play.openPatients(station.url, unseen);
    await other.listed("P07").click();
    await other.button(en.patient.edit).click();
    await patients.fieldLike(en.fields["contraindications"]!).fill("open wound");
    await patients.button(en.save).click();
    await patients.patient("P07").getByText("open wound").first().waitFor();
    await other.field(en.fields["note"]!).fill("likes music");
    await other.button(en.save).click();
    await other.page.getByRole("alert").getByText("changed meanwhile").waitFor();
    await other.page.close();
  });

  it("hides all of the patients while it is locked, and STOP works", async () => {
    await patients.button(en.lock.now).click();
    await patients.page.getByText(en.lock.hint).waitFor();
    expect(await patients.html()).not.toMatch(/P07|open wound/);
    await expectNoViolations("the locked page");
    await patients.stopButton.click();
    await cockpit.untilStopped();
    await patients.stopBox.getByText(strings.stop.confirmed("|").split("|")[0]!).first().waitFor();
    expect(await patients.html()).not.toMatch(/P07|open wound/);
  });

  it("shows them again after the lock", async () => {
    await patients.button(en.lock.goOn).click();
    await patients.listed("P07").click();
    await patients.patient("P07").getByText("open wound").first().waitFor();
    await expectNoViolations("a patient with a contraindication");
  });
});
