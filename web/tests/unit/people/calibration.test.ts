// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { CalibrationOffer } from "../../../src/people/calibration_offer";
import { calibrationSection, today } from "../../../src/people/calibration_section";
import { readExerciseNow } from "../../../src/people/exercise_now";
import { readPatient } from "../../../src/people/shapes";
import { words } from "../../../src/people/words";
import { hearCalibration, tellCalibration, wantedDialog, type CalibrationFiles } from "../../../src/wire/calibration_channel";

const bound = readPatient({ record: "aa", code: "P07", side: "left", calibration: "out/a.toml", calibration_device: "glove", calibration_serial: "12", calibration_expires: "2026-12-31" });
const flush = () => new Promise((resolve) => setTimeout(resolve, 20));

describe("the calibration of a patient", () => {
  it("is bound as the cockpit has told it, with a last day that is today until another one is typed", async () => {
    const saved: unknown[] = [];
    const section = calibrationSection(bound, { calibration: "out/b.toml", range: "", isNew: true }, (fields) => (saved.push(fields), Promise.resolve()), () => undefined);
    document.body.replaceChildren(section);
    expect(section.textContent).toContain(words.calibrate.bound("glove 12", "2026-12-31"));
    expect(section.querySelector("input")!.value).toBe(today());
    section.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(saved).toEqual([{ calibration: "out/b.toml", calibration_expires: today() }]);
  });

  it("offers nothing to bind where the patient has that file, and a range of that calibration alone", () => {
    const forms = (files: CalibrationFiles | undefined, isNew = true) =>
      calibrationSection(bound, files && { ...files, isNew }, () => Promise.resolve(), () => undefined).querySelectorAll("form").length;
    expect(forms({ calibration: "out/b.toml", range: "out/r.toml" }, false)).toBe(0);
    expect(forms(undefined)).toBe(0);
    expect(forms({ calibration: "out/a.toml", range: "" })).toBe(0);
    expect(forms({ calibration: "out/a.toml", range: "out/r.toml" })).toBe(1);
    expect(forms({ calibration: "out/b.toml", range: "out/r.toml" })).toBe(1);
    expect(forms({ calibration: "", range: "" })).toBe(0);
  });

  it("has the day of the station's calendar, which is UTC", () => {
    expect(today(new Date("2026-05-04T23:59:00Z"))).toBe("2026-05-04");
    expect(today(new Date("2026-05-04T23:59:00-05:00"))).toBe("2026-05-05");
  });

  it("tells that the dialog is opened", () => {
    let opened = 0;
    const section = calibrationSection(bound, undefined, () => Promise.resolve(), () => void ++opened);
    for (const link of section.querySelectorAll("a")) {
      link.addEventListener("click", (event) => event.preventDefault());
      link.click();
    }
    expect(opened).toBe(2);
  });
});

describe("the offer to bind a calibration", () => {
  const a = { calibration: "out/a.toml", range: "" };
  const b = { calibration: "out/b.toml", range: "" };
  const idle = readExerciseNow({ number: 3, stage: "ended" });
  /// Answers until files are known to be of no exercise.
  const answered = (offer: CalibrationOffer, now = idle) => [offer.heard(now), offer.heard(now)];

  it("is none without a dialog that was opened for a patient: another patient's file is in use", () => {
    const offer = new CalibrationOffer(() => true);
    offer.told(b);
    answered(offer);
    expect(offer.of("aa")).toBeUndefined();
    offer.begin("aa", idle);
    answered(offer);
    offer.told(b);
    answered(offer);
    expect(offer.of("aa"), "it has not changed since").toBeUndefined();
  });

  it("has a file that has changed since, for that patient alone", () => {
    const offer = new CalibrationOffer(() => true);
    offer.told(a);
    offer.begin("aa", idle);
    offer.told(b);
    expect(offer.of("aa"), "an exercise may have brought it").toBeUndefined();
    expect(answered(offer)).toEqual([false, true]);
    expect(offer.of("aa")).toEqual({ ...b, isNew: true });
    expect(offer.of("bb")).toBeUndefined();
    offer.told({ ...b, range: "out/r.toml" });
    answered(offer);
    expect(offer.of("aa")).toEqual({ calibration: "out/b.toml", range: "out/r.toml", isNew: true });
  });

  it("takes what a cockpit tells first, when none was open, for what was there before", () => {
    const offer = new CalibrationOffer(() => false);
    offer.begin("aa", idle);
    offer.told(a);
    expect(offer.of("aa")).toBeUndefined();
    offer.told({ ...a, range: "out/r.toml" });
    expect(offer.of("aa"), "without exercises it is offered at once").toEqual({ ...a, range: "out/r.toml", isNew: false });
  });

  it.each([
    ["is under way", readExerciseNow({ number: 4, stage: "opening" })],
    ["has been under way since", readExerciseNow({ number: 4, stage: "ended" })],
  ])("ends when an exercise %s", (_, now) => {
    const offer = new CalibrationOffer(() => true);
    offer.told(a);
    offer.begin("aa", idle);
    offer.told(b);
    offer.heard(now);
    answered(offer);
    expect(offer.of("aa")).toBeUndefined();
  });

  it("does not begin during an exercise", () => {
    const offer = new CalibrationOffer(() => true);
    offer.told(a);
    offer.begin("aa", readExerciseNow({ number: 4, stage: "running" }));
    offer.told(b);
    answered(offer, readExerciseNow({ number: 4, stage: "ended" }));
    expect(offer.of("aa")).toBeUndefined();
  });
});

describe("between the cockpit and the page of patients", () => {
  it("the files are told when they change, and to a page that opens later", async () => {
    const heard: CalibrationFiles[] = [];
    const tell = tellCalibration();
    tell({ calibration: "a", range: "" });
    tell({ calibration: "a", range: "" });
    hearCalibration((files) => heard.push(files));
    await flush();
    tell({ calibration: "b", range: "r" });
    await flush();
    expect(heard).toEqual([{ calibration: "a", range: "" }, { calibration: "b", range: "r" }]);
  });

  it.each([["?open=calibration", "calibration"], ["?open=range", "range"], ["?open=other", ""], ["", ""]])("the address %s opens “%s”", (search, wanted) => expect(wantedDialog(search)).toBe(wanted));
});
