// SPDX-License-Identifier: Apache-2.0
// The way of rehabilitation with accounts and a device on a wire: the therapist signs in, calibrates the simulated device in the cockpit's
// dialog, binds that to the patient, and begins a game. In its middle the link is cut: forces are off, the pages say why, and the session goes
// on after a reset. A second page of the therapist shows the same. A second cut ends the exercise whole: what was measured is kept.
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import type { Tick } from "../../src/gen/phalanx/tick_pb";
import { english } from "../../src/strings";
import { en as screenTexts } from "../../src/strings/patient_en";
import { en } from "../../src/strings/people_en";
import { accounts, DeviceStation, kPassword, type Account } from "./rehabilitation_device";
import { CockpitPage } from "./support/cockpit_page";
import type { PatientScreen } from "./support/patient_screen";
import type { PatientsPage } from "./support/patients_page";
import { shoot } from "./support/pictures";
import { stage, unseen, type PageWishes } from "./support/stage";
import { until } from "./support/until";

const kCode = "SIM7";
const kGame = "Training: press and hold with the index finger"; // of River
const kApart = 22; // angles of two positions that a goniometer can tell [deg]
const kSame = 1; // readings of one position [deg]
const kStill = 0.5; // [s]
const kAttemptMs = 40_000; // of real time at half the pace: two of the patient's squeezes
const kCalibrationMs = 3_600_000;
const kScene = ["index_ball"];
const readable: PageWishes = { ...unseen, viewport: { width: 1200, height: 800 }, deviceScaleFactor: 1 }; // its pictures are looked at

const play = stage();
const folder = mkdtempSync(join(tmpdir(), "phalanx-rehabilitation-"));
let own: DeviceStation;
let patients: PatientsPage;
let second: PatientsPage; // another page of the therapist
let screen: PatientScreen;
let onlooker: CockpitPage;

const panelOn = (page: PatientsPage) => page.page.getByRole("region", { name: en.run.region(kCode), exact: true });
const panel = () => panelOn(patients);
const phase = (page = patients) => panelOn(page).locator(".run-phase").innerText();
const largest = (tick: Tick) => Math.max(...tick.torque.map(Math.abs));
const degrees = (radians: number) => (180 * radians) / Math.PI;

async function signIn(page: PatientsPage, { name }: Account): Promise<void> {
  await page.fieldLike(en.signIn.account).fill(name);
  await page.page.getByLabel(en.signIn.password).fill(kPassword);
  await page.button(en.signIn.submit).click();
}

async function untilPhase(wanted: string, page = patients): Promise<void> {
  await until(`the phase ${wanted}`, async () => (await phase(page)).startsWith(wanted), async () => `${await panelOn(page).innerText()}\n${own.brief()}`);
}

/// The trial that is carried out, from 1.
const trial = async () => Number(/Trial (\d+)/.exec(await phase())?.[1] ?? 0);

/// Not untilState(): it throws while the fault is still there.
async function untilReset(page: CockpitPage): Promise<void> {
  await until("no fault", () => page.stream.state?.fault === undefined && page.stream.state?.stationGone === false, () => page.brief());
}

beforeAll(async () => {
  own = await DeviceStation.start(folder, kScene);
  patients = await play.openPatients(own.url, readable);
});
afterAll(async () => {
  await (own as DeviceStation | undefined)?.end(); // it may not have started
  rmSync(folder, { recursive: true, force: true });
});

describe("rehabilitation with a device on a wire", () => {
  it("lets a therapist sign in, and shows nothing to the account of a screen", async () => {
    await signIn(patients, accounts.screen);
    await patients.page.getByText(en.signIn.noPatients(en.roles["patient_screen"]!)).waitFor();
    await shoot(patients.page, "rehabilitation_device_1_no_patients");
    await signIn(patients, accounts.therapist);
    await patients.page.getByText(en.signIn.as(accounts.therapist.name, en.roles["therapist"]!)).waitFor();
    await patients.add(kCode, "right");
    await patients.button(en.patient.edit).click();
    await patients.page.getByRole("switch", { name: en.fields["consent"]! }).click();
    await patients.button(en.save).click();
    await patients.patient(kCode).getByText(en.calibrate.none).waitFor();
    await shoot(patients.page, "rehabilitation_device_1_patient");
  });

  it("calibrates the device in the cockpit, and binds the file to the patient", async () => {
    const [tab] = await Promise.all([patients.page.context().waitForEvent("page"), patients.page.getByRole("link", { name: en.calibrate.open }).click()]);
    const cockpit = new CockpitPage(tab);
    const words = english.texts.calibration;
    const dialog = tab.getByRole("dialog", { name: words.deviceTitle });
    await dialog.waitFor();
    for (const [digit, name] of english.texts.digits.entries()) if (digit !== 1) await dialog.getByRole("switch", { name, exact: true }).click();
    await cockpit.button(words.begin).click();
    const wizard = () => cockpit.stream.state?.wizard;
    await until("the first step", () => wizard()?.pose === 0, () => cockpit.brief());
    let first = 0;
    // The page must enter a number and begin to measure while the hand is still. Where the computer is too busy for that, time passes more
    // slowly from attempt to attempt.
    let pace = 0.5;
    const atPace = (wanted: number) => {
      own.setPace((pace = wanted));
      return Date.now() + (0.5 * kAttemptMs) / pace;
    };
    let attemptEnds = atPace(pace);
    for (const position of [0, 1]) {
      await until(`position ${position + 1} is measured`, async () => {
        if (Date.now() > attemptEnds) attemptEnds = atPace(pace / 4);
        const now = wizard();
        const present = degrees(now?.joint[0]?.present ?? NaN); // of the device's own numbers, as a goniometer on its hand
        if (now?.done[position] === true) return true;
        const there = position === 0 ? present < kApart / 2 : present > first + kApart;
        if (!now || now.measuring || !there || now.stillFor < kStill) return false;
        const read = Math.round(present);
        if (position === 0) first = read;
        const isEntered = () => Math.abs(degrees(wizard()?.joint[0]?.target ?? NaN) - read) < kSame;
        if (!isEntered()) {
          await dialog.getByRole("textbox").first().fill(String(read));
          await dialog.getByRole("textbox").first().press("Enter");
          await until("the angle is entered", isEntered, () => cockpit.brief());
          if (position === 1) await shoot(tab, "rehabilitation_device_2_angle");
          return false; // the hand may have left meanwhile: it is measured while it is there
        }
        await cockpit.button(words.measure).click();
        const hasMoved = () => (wizard()?.stillFor ?? 0) < kStill; // and nothing was measured
        await until("it is being measured", () => wizard()?.measuring === true || wizard()?.done[position] === true || hasMoved(), () => cockpit.brief());
        await until("it is measured, or refused", () => wizard()?.measuring === false, () => cockpit.brief());
        return false; // where the hand has moved, at its next hold
      }, () => `${JSON.stringify(wizard()?.joint)} still for ${wizard()?.stillFor} s; ${cockpit.brief()}`, kCalibrationMs);
    }
    atPace(1);
    await until("the end of all steps", async () => {
      const now = wizard();
      if (now && now.pose >= now.name.length) return true;
      if (now) await cockpit.button(words.skip).click();
      await until("another step", () => (wizard()?.pose ?? 0) !== now?.pose, () => cockpit.brief());
      return false;
    }, () => cockpit.brief());
    expect(wizard()!.problem).toEqual([]);
    await shoot(tab, "rehabilitation_device_2_calibrated");
    await cockpit.button(words.write).click();
    await cockpit.untilState("the station with the new file", (state) => state.wizard === undefined && !state.stationGone && state.busy === "");
    await patients.page.bringToFront();
    const bind = patients.button(en.calibrate.bind(kCode));
    await bind.scrollIntoViewIfNeeded();
    await shoot(patients.page, "rehabilitation_device_2_bind");
    await bind.click();
    await patients.patient(kCode).getByText("valid until").first().waitFor();
    expect(readdirSync(join(folder, "out/calibrations")).length).toBe(1);
    await own.cut();
    await until("the fault", () => cockpit.stream.state?.fault !== undefined, () => cockpit.brief());
    await own.plugIn(); // with its own time
    await cockpit.button(english.texts.fault.reset).click();
    await untilReset(cockpit);
    await tab.close();
  }, kCalibrationMs);

  it("prescribes from a template, and takes what was measured on another day", async () => {
    await patients.button(en.templates.use(en.templates.names["mild"]!)).click();
    await patients.patient(kCode).getByText(kGame).first().waitFor();
    await patients.patient(kCode).getByText(en.obstacles["unchecked"]!).first().waitFor();
    await patients.enter(en.fields["entry"]!, { [en.steps.flexion]: "45", [en.steps.release]: "30" });
    await patients.enter(en.fields["own_force_n"]!, { [english.texts.digits[1]!]: "4" });
    await shoot(patients.page, "rehabilitation_device_3_prescribed");
  });

  it("signs the patient's screen in with an account of its own", async () => {
    screen = await play.openPatientScreen(own.url, unseen);
    const form = screen.page.locator(".sign-in");
    await form.getByLabel(screenTexts.signIn.account).fill(accounts.screen.name);
    await form.getByLabel(screenTexts.signIn.password).fill(kPassword);
    await shoot(screen.page, "rehabilitation_device_4_sign_in");
    await form.getByRole("button", { name: screenTexts.signIn.submit }).click();
    await screen.until("greet");
    await shoot(screen.page, "rehabilitation_device_4_greet");
    onlooker = await play.open(own.url, unseen); // without an account
  });

  it("begins a game on the device", async () => {
    await patients.page.getByRole("button", { name: `${en.begin.begin}: ${kGame}` }).first().click();
    await patients.page.getByRole("radio", { name: en.begin.device }).click();
    await shoot(patients.page, "rehabilitation_device_5_confirm");
    await patients.button(en.begin.confirm(kCode, en.sides["right"]!)).click();
    await patients.button(en.run.start).click();
    await patients.button(en.run.skip).click();
    for (const kind of ["pain", "fatigue"] as const) {
      const scale = panel().getByRole("group", { name: en.run[kind], exact: true });
      await until(`the question of ${kind}`, async () => (await scale.getAttribute("data-asked")) === "true" && (await scale.getAttribute("data-settling")) === "false", () => panel().innerText());
      await scale.getByRole("button", { name: "1", exact: true }).click();
    }
    await untilPhase("Trial");
    await screen.until("play");
    await until("torque", async () => largest((await onlooker.stream.next(1)).at(-1)!) > 0, () => own.brief());
    await shoot(screen.page, "rehabilitation_device_5_play");
    await shoot(patients.page, "rehabilitation_device_5_therapist");
  });

  it("shows a second page of the therapist the same, and either may pause and go on", async () => {
    second = await play.openPatients(own.url, readable);
    await signIn(second, accounts.therapist);
    await panelOn(second).waitFor(); // a page that comes to an exercise goes to it
    await patients.button(en.run.pause).click();
    await second.button(en.run.resume).waitFor();
    await panelOn(second).getByText(en.run.forcesOff).waitFor();
    await shoot(second.page, "rehabilitation_device_6_second");
    await second.button(en.run.resume).click();
    await patients.button(en.run.pause).waitFor();
    await second.button(en.run.pause).waitFor();
  });

  it("takes a break that the patient asks for on the screen", async () => {
    await screen.until("play");
    await screen.page.locator(".bar-pause").click();
    await screen.until("break");
    await until("the words of a break", async () => (await screen.goal.innerText()) === screenTexts.screen.paused, () => screen.goal.innerText());
    await shoot(screen.page, "rehabilitation_device_7_break");
    for (const page of [patients, second]) await page.button(en.run.resume).waitFor();
    await patients.button(en.run.resume).click();
    await screen.until("play");
  });

  it("takes the forces off when the link is cut, says so, and goes on after a reset", async () => {
    await untilPhase("Trial");
    const before = await trial();
    await own.cut();
    await until("the pause", async () => (await phase()).startsWith(en.run.phases["paused"]!), () => panel().innerText());
    await panel().getByText(en.run.forcesOff).waitFor();
    await panel().getByText(/No sample has come from the device|port or socket failed/).waitFor();
    await until("the words of the patient's screen", async () => (await screen.goal.innerText()) === screenTexts.screen.fault, () => screen.goal.innerText());
    for (const tick of await onlooker.stream.next(5)) expect(largest(tick), `tick ${tick.tick}`).toBe(0);
    await shoot(patients.page, "rehabilitation_device_8_cut_therapist");
    await shoot(screen.page, "rehabilitation_device_8_cut_screen");
    await shoot(onlooker.page, "rehabilitation_device_8_cut_onlooker");
    await own.plugIn();
    await patients.button(en.run.reset).click();
    await untilReset(onlooker);
    await patients.button(en.run.resume).click();
    await patients.button(en.run.pause).waitFor();
    await screen.until("play");
    await until("the next trial", async () => (await phase()).startsWith("Trial") && (await trial()) > before, () => panel().innerText());
    await shoot(patients.page, "rehabilitation_device_8_went_on");
  });

  it("ends whole after a second cut, and keeps what was measured", async () => {
    await own.cut();
    await until("the pause", async () => (await phase()).startsWith(en.run.phases["paused"]!), () => panel().innerText());
    await patients.button(en.run.end).click();
    await patients.button(en.run.endYes).click();
    await panel().getByText(en.run.interrupted).waitFor();
    await panelOn(second).getByText(en.run.interrupted).waitFor();
    await screen.until("done");
    await shoot(screen.page, "rehabilitation_device_9_done");
    await shoot(patients.page, "rehabilitation_device_9_result");
    await patients.button(en.run.back(kCode)).click();
    await patients.patient(kCode).getByText(en.results.interrupted).first().scrollIntoViewIfNeeded();
    await shoot(patients.page, "rehabilitation_device_9_course");
    expect(readdirSync(join(folder, "out/recordings")).filter((name) => name.endsWith(".torn"))).toEqual([]);
  });
});
