// SPDX-License-Identifier: Apache-2.0
// The whole way of rehabilitation against the program: a therapist adds three simulated patients, takes a template, and each of them plays the
// same game on the patient's screen. In the middle of a game an onlooker stops, and both pages are loaded again. Exercises are short: the
// warm-up is skipped, and each game is ended early.
import { beforeAll, describe, expect, it } from "vitest";
import type { Tick } from "../../src/gen/phalanx/tick_pb";
import { en as screenTexts } from "../../src/strings/patient_en";
import { english } from "../../src/strings";
import { en } from "../../src/strings/people_en";
import type { CockpitPage } from "./support/cockpit_page";
import { shoot } from "./support/pictures";
import type { PatientScreen } from "./support/patient_screen";
import type { PatientsPage } from "./support/patients_page";
import { stage, unseen, type OwnStation } from "./support/stage";
import { kHangMs, until } from "./support/until";

const kSkills = { SIM1: "healthy", SIM2: "moderate", SIM3: "severe" } as const;
type Code = keyof typeof kSkills;
const codes = Object.keys(kSkills) as Code[];
const kTemplate = "mild";
const kGame = "Training: press and hold with the index finger"; // of River
const kTrials = 3; // that count, for each of them
const kStoryMs = 3 * kHangMs;

const play = stage();
let station: OwnStation;
let patients: PatientsPage;
let screen: PatientScreen;
let onlooker: CockpitPage;

const panel = (code: Code) => patients.page.getByRole("region", { name: en.run.region(code), exact: true });
const largest = (tick: Tick) => Math.max(...tick.torque.map(Math.abs));

/// Trials that count, as the panel says.
async function counted(code: Code): Promise<number> {
  const found = /\d+ of (\d+) successful/.exec(await panel(code).innerText());
  return Number(found?.[1] ?? 0);
}

/// Skips the warm-up, and waits until `done`. Rests pass: a press that comes late would skip the trial behind one.
async function skipUntil(code: Code, what: string, done: () => Promise<boolean>): Promise<void> {
  await until(
    what,
    async () => {
      if (await done()) return true;
      const phase = await panel(code).locator(".run-phase").innerText();
      if (phase.startsWith(en.run.phases["warm_up"]!)) await patients.button(en.run.skip).click({ timeout: 1000 }).catch(() => undefined); // it may have ended meanwhile
      return false;
    },
    () => panel(code).innerText(),
  );
}

async function begin(code: Code, title: string): Promise<void> {
  await patients.listed(code).click();
  await patients.patient(code).waitFor();
  await patients.page.getByRole("button", { name: `${en.begin.begin}: ${title}` }).first().click();
  await patients.page.getByRole("radio", { name: en.begin.skills[kSkills[code]]! }).click();
  await patients.button(en.begin.confirm(code, en.sides["right"]!)).click();
  await patients.button(en.run.start).click();
}

async function endEarly(code: Code): Promise<void> {
  await patients.button(en.run.end).click();
  await patients.button(en.run.endYes).click();
  await panel(code).getByText(en.run.interrupted).waitFor();
}

beforeAll(async () => {
  station = await play.ownStation(["first_touch", "--data", "data", "--keys", "config/keys"]);
  onlooker = await play.open(station.url, unseen);
  patients = await play.openPatients(station.url, unseen);
  screen = await play.openPatientScreen(station.url, unseen);
  await patients.page.getByText(en.signIn.owner).waitFor();
});

describe("rehabilitation", () => {
  it("begins with three patients, each with a prescription from a template", async () => {
    for (const code of codes) {
      await patients.button(en.list.add).click();
      await patients.fieldLike(en.fields["code"]!).fill(code);
      await patients.page.getByRole("radio", { name: en.sides["right"]! }).click();
      await patients.page.getByRole("switch", { name: en.fields["consent"]! }).click();
      await patients.page.getByRole("radio", { name: en.templates.names[kTemplate]! }).click();
      await patients.button(en.save).click();
      await patients.patient(code).getByText(kGame).first().waitFor();
    }
  });

  it("refuses a game before the entry check, and takes what was measured on another day", async () => {
    await patients.listed("SIM1").click();
    await patients.patient("SIM1").getByText(en.obstacles["unchecked"]!).first().waitFor();
    for (const code of codes) {
      await patients.listed(code).click();
      await patients.enter(en.fields["entry"]!, { [en.steps.flexion]: "45", [en.steps.release]: "30" });
      await patients.enter(en.fields["own_force_n"]!, { [english.texts.digits[1]!]: "4" });
    }
  });

  it.each(codes)("lets %s play, whose goal is on the patient's screen", { timeout: kStoryMs }, async (code) => {
    await begin(code, kGame);
    await skipUntil(code, "the first trial", async () => (await panel(code).locator(".run-phase").innerText()).startsWith("Trial"));
    await screen.until("play");
    await until("the goal in the patient's words", async () => (await screen.goal.innerText()) === screenTexts.goals["Press until the bar is in the band, and hold it there."], () => screen.goal.innerText());
    await shoot(screen.page, `rehabilitation_screen_${code}`);
    await shoot(patients.page, `rehabilitation_therapist_${code}`);
    if (code === "SIM1") await stopAndReload(code);
    await skipUntil(code, `${kTrials} trials`, async () => (await counted(code)) >= kTrials);
    await endEarly(code);
    await patients.button(en.run.back(code)).click();
    await patients.patient(code).getByText(en.results.interrupted).first().waitFor();
  });

  it("ends with a report in a window of its own, and with the same values in FHIR", async () => {
    const [report] = await Promise.all([patients.page.waitForEvent("popup"), patients.button(en.documents.report).click()]);
    await report.getByText("SIM3").first().waitFor();
    expect(await report.locator("body").innerText()).toContain(kGame.split(": ")[1]);
    await report.close();
    const [file] = await Promise.all([patients.page.waitForEvent("download"), patients.button(en.documents.fhir).click()]);
    expect(file.suggestedFilename()).toBe("SIM3-course.fhir.json");
  });
});

/// An onlooker stops in the middle of the game: there is no torque and the exercise pauses, until the therapist goes on. Then both pages are
/// loaded again, and come back to the exercise.
async function stopAndReload(code: Code): Promise<void> {
  await until("torque", async () => largest((await onlooker.stream.next(1)).at(-1)!) > 0, () => onlooker.brief());
  await onlooker.stopButton.click();
  await panel(code).getByText(en.run.forcesOff).waitFor();
  await patients.button(en.run.resume).waitFor();
  await until("the end of the stop's ramp", async () => largest((await onlooker.stream.next(1)).at(-1)!) === 0, () => onlooker.brief());
  for (const tick of await onlooker.stream.next(10)) expect(largest(tick), `tick ${tick.tick}`).toBe(0);
  await shoot(screen.page, "rehabilitation_screen_stopped");
  const [goOn, wait] = await Promise.all([patients.button(en.run.resume).boundingBox(), patients.page.locator(".run-main", { hasText: en.run.pause }).boundingBox()]);
  expect(goOn!.x + goOn!.width <= wait!.x || goOn!.y + goOn!.height <= wait!.y, "“Go on” is not where “Pause” was").toBe(true);
  await patients.button(en.run.resume).click();
  await patients.button(en.run.pause).waitFor();
  await patients.page.reload();
  await panel(code).waitFor();
  await screen.page.reload();
  await screen.until("play");
}
