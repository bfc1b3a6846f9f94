// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it } from "vitest";
import { Calibrate_Step as Step, Wizard_Method as Method, WizardSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { calibrationDialog, type CalibrationDialog, type CalibrationShown } from "../../../src/panels/calibration_dialog";
import { calibrationWords, jointName, poseName } from "../../../src/panels/joint_table";
import { wizardSection } from "../../../src/panels/wizard";
import { calibratedHands } from "../../../src/state/calibrated_hands";
import { strings } from "../../../src/strings";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

const words = strings.calibration;
const rad = Math.PI / 180;
const onWire = { operatorPage: kMe, source: 0, deviceSimulated: false, calibration: "c.toml" };
let fake: FakeApp;
let dialog: CalibrationDialog;
let shown: CalibrationShown[];

const flush = () => Promise.resolve().then(() => {}).then(() => {});
const named = (text: string) => [...dialog.element.querySelectorAll("button")].find((one) => one.textContent === text)!;
const visible = (element: Element): boolean => element === dialog.element ? !dialog.element.hidden : !(element as HTMLElement).hidden && visible(element.parentElement!);
const wizard = (value: MessageInitShape<typeof WizardSchema>) => fake.state({ ...onWire, stationGone: true, wizard: value });
const goniometer = { name: ["index_pip_flexion first", "index_pip_flexion second"], done: [true, false], pose: 1, method: Method.GONIOMETER, instruction: "Hold it." };

beforeEach(() => {
  fake = fakeApp();
  shown = [];
  dialog = calibrationDialog(fake.app, (on) => shown.push(on));
  document.body.replaceChildren(dialog.element);
  fake.state(onWire);
});

describe("the dialog of a calibration", () => {
  it("asks for the method and the fingers, and begins with them", async () => {
    expect(dialog.element.hidden).toBe(true);
    dialog.askDevice();
    expect(shown).toEqual(["asking"]); // the station runs: verdict and forces stay in sight
    named(strings.digits[0]!).click(); // without the thumb
    dialog.element.querySelector<HTMLInputElement>(`input[value="${Method.JIG}"]`)!.checked = true;
    named(words.begin).click();
    await flush();
    expect(fake.calibrated).toEqual([{ step: Step.BEGIN, method: Method.JIG, digit: [1, 2, 3, 4] }]);
  });

  it("asks for nothing of no finger, and says so", async () => {
    dialog.askDevice();
    for (const digit of strings.digits) named(digit).click();
    named(words.begin).click();
    await flush();
    expect(fake.calibrated).toEqual([]);
    expect(dialog.element.querySelector(".refused")!.textContent).toBe(words.noFinger);
  });

  it("begins a range with the patient's label", async () => {
    dialog.askRange();
    dialog.element.querySelector<HTMLInputElement>("input[type=text]")!.value = " P07 ";
    named(words.begin).click();
    await flush();
    expect(fake.calibrated).toEqual([{ step: Step.BEGIN_RANGE, patient: "P07" }]);
  });

  it("shows which joint goes how far, and whether it is still", () => {
    wizard({ ...goniometer, joint: [{ joint: 6, target: 52 * rad, present: 38 * rad, mayEnter: true }], stillFor: 0.1 });
    expect(dialog.element.hidden).toBe(false);
    const text = dialog.element.textContent!;
    for (const part of [words.step(2, 2, words.poseOf(jointName(6), words.references["second"]!)), "Hold it.", "38°", words.toGo("52", "14", true), words.moving, words.torqueZero]) expect(text).toContain(part);
    wizard({ ...goniometer, joint: [{ joint: 6, target: 52 * rad, present: 51 * rad, mayEnter: true }], stillFor: 0.6 });
    expect(dialog.element.textContent).toContain(words.there("52"));
    expect(dialog.element.querySelector(".stillness")!.getAttribute("data-still")).toBe("true");
  });

  it("measures only with an angle that was entered", async () => {
    wizard({ ...goniometer, joint: [{ joint: 6, present: 0.5, mayEnter: true }] });
    expect(named(words.measure).disabled).toBe(true);
    const input = dialog.element.querySelector<HTMLInputElement>(".joint-entry input")!;
    input.value = "41,5";
    input.dispatchEvent(new Event("change"));
    await flush();
    expect(fake.calibrated[0]).toMatchObject({ step: Step.ENTER, pose: 1, joint: 6 });
    expect(fake.calibrated[0]!.angle).toBeCloseTo(41.5 * rad, 9);
    wizard({ ...goniometer, joint: [{ joint: 6, target: 41.5 * rad, present: 0.5, mayEnter: true }] });
    expect(named(words.measure).disabled).toBe(false);
  });

  it("takes no angle that is none", () => {
    wizard({ ...goniometer, joint: [{ joint: 6, mayEnter: true }] });
    const input = dialog.element.querySelector<HTMLInputElement>(".joint-entry input")!;
    for (const typed of ["", "far"]) {
      input.value = typed;
      input.dispatchEvent(new Event("change"));
    }
    expect(fake.calibrated).toEqual([]);
  });

  it("accepts, repeats or leaves out a finger's range", async () => {
    wizard({ ofRange: true, digit: [1, 2], done: [false, false], pose: 0, measuring: true, joint: [{ joint: 6, present: 0.2, reachedMin: 2 * rad, reachedMax: 40 * rad, limitMin: 0, limitMax: 100 * rad }] });
    expect(dialog.element.textContent).toContain(words.reached("2", "40", words.span("0", "100")));
    expect(dialog.element.textContent).toContain(words.moveFinger(strings.openings.digits[1]!));
    for (const one of [words.accept, words.again, words.skip]) named(one).click();
    await flush();
    expect(fake.calibrated.map((request) => request.step)).toEqual([Step.ACCEPT, Step.MEASURE, Step.SKIP]);
  });

  it("can be written only when it is finished, and says what was refused", () => {
    wizard({ ...goniometer, pose: 2, problem: ["too near"] });
    expect(dialog.element.textContent).toContain("too near");
    expect(visible(named(words.write))).toBe(false);
    wizard({ ...goniometer, pose: 2, finished: true, result: ["index: good"] });
    expect(visible(named(words.write))).toBe(true);
    expect(dialog.element.textContent).toContain("index: good");
  });

  it("is seen but not used by a page without control, and goes with the calibration", () => {
    fake.state({ ...onWire, operatorPage: kMe + 1, wizard: goniometer });
    expect(dialog.element.hidden).toBe(false);
    expect(visible(named(strings.role.take))).toBe(true);
    expect(dialog.element.querySelector("fieldset")!.disabled).toBe(true);
    fake.state(onWire);
    expect(dialog.element.hidden).toBe(true);
    expect(shown).toEqual(["on", ""]);
  });
});

describe("the device's tab", () => {
  it("measures a range only on a calibrated device, and says which limits hold", () => {
    const section = wizardSection(fake.app, dialog);
    const range = [...section.querySelectorAll("button")].find((one) => one.textContent === words.range)!;
    fake.state({ ...onWire, calibration: "" });
    expect([range.disabled, section.textContent?.includes(words.noRange)]).toEqual([true, true]);
    fake.state({ ...onWire, range: "out/ranges/1.toml" });
    expect([range.disabled, section.textContent?.includes(words.limitedBy("out/ranges/1.toml"))]).toEqual([false, true]);
  });

  it("ends the use of a patient's range only after a question", async () => {
    const section = wizardSection(fake.app, dialog);
    const drop = [...section.querySelectorAll("button")].find((one) => one.textContent === words.dropRange)!;
    fake.state(onWire);
    expect(drop.hidden).toBe(true);
    fake.state({ ...onWire, range: "out/ranges/1.toml" });
    expect(drop.hidden).toBe(false);
    drop.click();
    expect(fake.calibrated).toEqual([]);
    [...fake.app.dialogs.querySelectorAll("button")].find((one) => one.textContent === words.dropRange)!.click();
    await flush();
    expect(fake.calibrated).toEqual([{ step: Step.DROP_RANGE }]);
  });
});

describe("the view during a calibration", () => {
  it("shows the hand as it is and a ghost where it is to go, and is not dead", () => {
    const hand = [1, 2, 3];
    const target = [4, 5, 6];
    expect(calibratedHands(undefined)).toBeUndefined();
    expect(calibratedHands(create(WizardSchema, {}))).toBeUndefined();
    const both = calibratedHands(create(WizardSchema, { hand, target }))!;
    expect([both.gdpPose, both.hcpPose]).toEqual([hand, target]);
    expect(calibratedHands(create(WizardSchema, { hand }))!.hcpPose).toEqual(hand);
    fake.state({ ...onWire, stationGone: true });
    expect(fake.store.calibrating).toBe(false);
    wizard({ ...goniometer, hand });
    expect([fake.store.calibrating, fake.store.viewDead]).toEqual([true, false]);
    fake.store.setPhase("waiting");
    expect([fake.store.calibrating, fake.store.viewDead]).toEqual([false, true]);
  });
});

describe("the names of steps", () => {
  it("are those of the joints, in plain words", () => {
    expect(poseName("thumb_mcp_flexion largest")).toBe(words.poseOf(jointName(2), words.references["largest"]!));
    expect(poseName("ring_dip_flexion first")).toBe(words.poseOf(jointName(15), words.references["first"]!));
    for (const other of ["open hand", "fist", "index splay first"]) expect(poseName(other)).toBe(other);
  });
});

it("problems and results of a calibration name joints for people, without the numbers of the file", () => {
  expect(calibrationWords("angle of index_pip_flexion: 1.2345e-04 a count, offset -0.1234, from 3 poses, at most 0.50 deg off")).toBe(
    words.fitted(jointName(6), "3", "0.50"),
  );
  expect(calibrationWords("index_pip_flexion second: the angle of thumb_mcp_flexion is not entered")).toBe(
    `${words.poseOf(jointName(6), words.references["second"]!)}: the angle of ${jointName(2)} is not entered`,
  );
  expect(calibrationWords("curl of ring: the poses differ too little")).toBe(`${words.bending(strings.digits[3]!)}: the poses differ too little`);
});
