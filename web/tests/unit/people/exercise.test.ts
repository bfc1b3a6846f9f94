// SPDX-License-Identifier: Apache-2.0
// The therapist's way: from an empty system to the first repetition, and through an exercise.
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { beforeEach, describe, expect, it } from "vitest";
import { readExerciseNow } from "../../../src/people/exercise_now";
import { PeoplePage } from "../../../src/people/page";
import { words } from "../../../src/people/words";
import { en as exercise } from "../../../src/strings/exercise_en";
import { FakeApi } from "./fake_api";

const kMostTaps = 12;
const kSettled = 1100; // [ms]; then no button is held any longer

let station: FakeApi;
let page: PeoplePage;
let later: (() => void)[] = []; // what waits to ask for the exercise again
let taps = 0;
let time = 0; // [ms]

const flush = async () => {
  for (let i = 0; i < 8; ++i) await new Promise((resolve) => setTimeout(resolve));
};
/// The station has answered again.
async function next(): Promise<void> {
  later.splice(0).forEach((run) => run());
  await flush();
}
const shown = () => page.content.textContent ?? "";
const isSeen = (element: HTMLElement) => element.closest("[hidden]") === null;
const buttons = () => [...page.content.querySelectorAll("button")].filter(isSeen);
const button = (text: string) => buttons().find((one) => (one.getAttribute("aria-label") ?? one.textContent ?? "").startsWith(text) || one.textContent === text);
/// One tap of a finger, or one click.
async function tap(text: string): Promise<void> {
  const found = button(text);
  expect(found, `the button “${text}” is there`).toBeDefined();
  ++taps;
  if (found!.type === "submit") found!.closest("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
  else found!.click();
  await flush();
}
/// The station tells something else.
function justTold(change: Readonly<Record<string, unknown>>): Promise<void> {
  station.now = { ...station.now, ...change };
  return next();
}
/// Likewise, and a while has passed since.
async function told(change: Readonly<Record<string, unknown>>): Promise<void> {
  await justTold(change);
  time += kSettled;
  await next();
}

beforeEach(async () => {
  taps = 0;
  time = 0;
  later = [];
  station = new FakeApi();
  station.withAccounts = false;
  station.exercisesOn = true;
  page = new PeoplePage(station.api, () => time, () => undefined, (run) => void later.push(run));
  document.body.replaceChildren(page.account, page.content);
});

describe("the way from an empty system to the first repetition", () => {
  it(`takes at most ${kMostTaps} taps, the typing of the code aside`, async () => {
    station.kept = [];
    await page.begin();
    await flush();
    await tap(words.list.add);
    const code = document.activeElement as HTMLInputElement; // it has the focus: nothing is tapped to type
    expect(code.tagName).toBe("INPUT");
    code.value = "P30";
    await tap(words.sides["right"]!);
    await tap(words.fields["consent"]!);
    await tap("Assessment day");
    await tap(words.save);
    await tap(words.begin.begin);
    await tap(words.begin.confirm("P30", words.sides["right"]!));
    await tap(words.run.start);
    await told({ phase: "warm_up" });
    await tap(words.run.skip);
    await told({ phase: "rating", asks: "pain" });
    await tap("0");
    await told({ asks: "fatigue" });
    await tap("0");
    await told({ phase: "trial", asks: "", trial: 1, trials: 5 });
    expect(shown()).toContain(words.run.trial("1", "5"));
    console.log(`from an empty system to the first repetition: ${taps} taps`);
    expect(taps).toBeLessThanOrEqual(kMostTaps);
    const wanted = ["begin cc press P30 ", "input begin", "input skip", "input pain 0", "input fatigue 0"];
    expect(station.asked.filter((one) => /^(begin|input)/.test(one))).toEqual(wanted);
    const added = JSON.parse(station.asked.find((one) => one.startsWith("add "))!.slice("add ".length)) as Record<string, unknown>;
    expect(added).toMatchObject({ code: "P30", side: "right", consent: true, prescription: [{ exercise: "press", repetitions_per_day: 5, overrides: { pain_limit: "4" } }] });
    expect(added).not.toHaveProperty("template");
  });
});

async function openPatient(code: string): Promise<void> {
  await page.begin();
  await flush();
  [...page.content.querySelectorAll<HTMLButtonElement>(".patient-item")].find((one) => one.textContent!.includes(code))!.click();
  await flush();
}
async function beginOther(code: string): Promise<void> {
  await openPatient(code);
  page.content.querySelector<HTMLElement>(".begin-other .choice")!.click();
  [...page.content.querySelectorAll<HTMLElement>(".begin-other [role=option]")].find((one) => one.dataset["value"] === "press")!.click();
  await tap(`${words.begin.begin}: ${words.begin.other}`);
}

describe("before an exercise begins", () => {
  it("code, symbol and side are shown together, with what speaks against it, and no button has the focus", async () => {
    await beginOther("P07");
    const panel = page.content.querySelector(".confirm")!;
    for (const text of ["P07", words.begin.hand["left"]!, words.symbols["boat"]!, "skin at the thumb", words.obstacles["unchecked"]!]) expect(panel.textContent).toContain(text);
    expect(document.activeElement?.tagName).toBe("H2");
    expect(station.asked.some((one) => one.startsWith("begin"))).toBe(false);
    expect(panel.querySelector(".chips"), "a person does it").toBeNull();
  });

  it("the station's refusal stands beside the button", async () => {
    await beginOther("P07");
    Object.assign(station, { beginExercise: () => Promise.reject(new Error("P07 has a contraindication: open wound")) });
    await tap(words.begin.confirm("P07", words.sides["left"]!));
    expect(page.content.querySelector(".confirm .refused[role=alert]")!.textContent).toContain("open wound");
  });

  it("only a patient whose code begins with SIM has simulated participants, and no other", async () => {
    station.kept = [...station.kept, { ...station.kept[1]!, record: "ss", code: "SIM2" }];
    await beginOther("SIM2");
    await tap(words.begin.skills["severe"]!);
    await tap(words.begin.confirm("SIM2", words.sides["right"]!));
    expect(station.asked).toContain("begin ss press SIM2 severe");
    expect(shown()).toContain(words.run.simulated);
  });
});

describe("the exercise that runs", () => {
  beforeEach(async () => {
    await beginOther("P12");
    await tap(words.begin.confirm("P12", words.sides["right"]!));
  });

  it("shows instruction, goal, value and forces, and changes its own elements alone", async () => {
    const panel = page.content.querySelector(".people-run")!;
    await told({
      phase: "trial", trial: 2, trials: 8, remaining_s: 3.2, instruction: "Press.", target: { kind: "force", digits: ["index"], low: 1.5, high: 2.5 }, value: 2.04, value_unit: "N",
      force: [0, 2.04, 0.5, 0, 0], successes: 1, counted: 1,
    });
    expect(page.content.querySelector(".people-run")).toBe(panel);
    for (const text of ["Press", words.run.trial("2", "8"), words.run.left("4"), "2 N", words.run.inBand, words.run.band("1.5", "2.5 N"), "0.5 N"]) expect(shown()).toContain(text);
    await told({ value: 3.5 });
    expect(shown()).not.toContain(words.run.inBand);
  });

  it("has a button to pause and another one to go on, which states the stops that it has seen", async () => {
    await told({ phase: "trial", trial: 1, stops: 4 });
    expect(button(words.run.resume)).toBeUndefined();
    await tap(words.run.pause);
    await told({ phase: "paused", forces_off: true, stops: 5 });
    expect(shown()).toContain(words.run.forcesOff);
    expect(page.content.querySelector<HTMLElement>(".run-fault")!.hidden).toBe(true);
    await told({ fault: { name: "device_lost", meaning: "The port failed.", remedy: "Plug it in." } });
    expect(shown()).toContain("The port failed. Plug it in.");
    await told({ fault: null });
    expect(shown()).not.toContain("The port failed.");
    expect(button(words.run.pause)).toBeUndefined();
    await tap(words.run.resume);
    expect(station.asked.filter((one) => one.startsWith("input"))).toEqual(["input pause", "input resume 5"]);
  });

  it("has “Pause” and “Go on” at two places, which they keep while they are not for now", async () => {
    await told({ phase: "trial", trial: 1 });
    const row = page.content.querySelector(".run-buttons")!;
    const places = () => [...row.querySelectorAll("button")].map((one) => one.textContent);
    const before = places();
    const [goOn, pause] = [words.run.resume, words.run.pause].map((text) => [...row.querySelectorAll("button")].find((one) => one.textContent === text)!) as [HTMLButtonElement, HTMLButtonElement];
    expect(goOn.parentElement, "two cells").not.toBe(pause.parentElement);
    expect([goOn.disabled, pause.disabled]).toEqual([true, false]);
    await told({ phase: "paused", forces_off: true });
    expect(places()).toEqual(before);
    expect([goOn.disabled, pause.disabled]).toEqual([false, true]);
    const style = readFileSync(resolve(__dirname, "../../../src/style/people.css"), "utf8");
    expect(style, "a hidden button keeps its cell").toMatch(/\.run-buttons button\[hidden\],[^}]*display: block !important;\s*visibility: hidden;/);
  });

  it("goes on by no second tap, not until a second after the last pause or stop", async () => {
    await told({ phase: "trial", trial: 1, stops: 4 });
    await tap(words.run.pause);
    await justTold({ phase: "paused", forces_off: true, stops: 5 });
    const goOn = button(words.run.resume)!;
    const presses = () => {
      goOn.dispatchEvent(new MouseEvent("click", { bubbles: true }));
      return station.asked.filter((one) => one.startsWith("input resume"));
    };
    expect(presses()).toEqual([]);
    time += 900;
    await next();
    expect(presses()).toEqual([]);
    await justTold({ stops: 6 }); // another stop
    time += 900;
    await next();
    expect(presses()).toEqual([]);
    time += 200;
    await next();
    expect(goOn.disabled).toBe(false);
    expect(presses()).toEqual(["input resume 6"]);
  });

  it("states for which exercise an input is", async () => {
    await told({ phase: "trial", trial: 1, stops: 4 });
    await tap(words.run.pause);
    await tap("75 %");
    expect(station.meant).toEqual([1, 1]);
  });

  it("takes no rating and no answer just after the question has changed", async () => {
    await justTold({ phase: "rating", asks: "pain" });
    await tap("3");
    time += 900;
    await tap("3");
    await justTold({ asks: "fatigue" });
    await tap("9");
    time += 700;
    await tap("9");
    time += 200;
    await tap("2");
    await justTold({ asks: "", phase: "answer", choices: ["the first", "the second"] });
    await tap("The first one");
    time += 900;
    await tap("The second one");
    await tap("The second one");
    expect(station.asked.filter((one) => one.startsWith("input"))).toEqual(["input pain 3", "input fatigue 2", "input answer 2"]);
  });

  it("skips one phase by a double press, not what comes next", async () => {
    await told({ phase: "warm_up" });
    await tap(words.run.skip);
    await tap(words.run.skip);
    await justTold({ phase: "rating", asks: "pain" });
    await tap(words.run.skip);
    const skips = () => station.asked.filter((one) => one === "input skip").length;
    expect(skips()).toBe(1);
    const skip = button(words.run.skip)!;
    expect([skip.getAttribute("aria-disabled"), skip.disabled], "it keeps the focus").toEqual(["true", false]);
    time += 700;
    await tap(words.run.skip);
    expect(skips()).toBe(1);
    time += 200;
    await next();
    expect(skip.getAttribute("aria-disabled")).toBe("false");
    await tap(words.run.skip);
    expect(skips()).toBe(2);
    await told({ phase: "trial", asks: "", trial: 1, trials: 3 });
    await justTold({ trial: 2 });
    await tap(words.run.skip);
    expect(skips(), "another trial has just begun").toBe(2);
  });

  it("keeps the focus in sight: not on a button, which a key that is held down would press", async () => {
    await told({ phase: "ready" });
    button(words.run.start)!.focus();
    await tap(words.run.start);
    await told({ phase: "warm_up" });
    expect(document.activeElement?.className).toBe("run-now");
    button(words.run.end)!.focus();
    await tap(words.run.end);
    expect(document.activeElement?.className).toBe("run-sure");
    await tap(words.run.endNo);
    expect(document.activeElement).toBe(button(words.run.end));
    await tap(words.run.end);
    button(words.run.endYes)!.focus();
    await told({ stage: "ended", phase: "done" });
    expect(document.activeElement?.className).toBe("run-result");
  });

  it("tells what the patient's screen tells, and its own words between trials", async () => {
    const says = () => page.content.querySelector<HTMLElement>(".run-instruction:not([hidden])")?.textContent;
    await told({ phase: "warm_up", instruction: "Warm up: move your fingers freely." });
    expect(says()).toBe(exercise.warmUp);
    await told({ phase: "rating", asks: "pain", instruction: "How strong is your pain now? Answer with: pain N" });
    expect(says()).toBe(words.run.told.pain);
    await told({ phase: "rest", asks: "", instruction: "Let go. The second one comes." });
    expect(says()).toBe(exercise.second);
    await told({ phase: "trial", instruction: "Move only this finger (ring)", target: { kind: "angle" } });
    expect(says()).toBe("Move only this finger: your ring finger");
    await told({ phase: "answer", measure: "feel_and_find", choices: ["the first"] });
    expect(says()).toBe(exercise.softer);
  });

  it("gives way to the next patient's, whose inputs are for that one", async () => {
    await told({ phase: "trial", trial: 1 });
    await told({ number: 2, record: "aa", code: "P07", phase: "trial" });
    expect(page.content.querySelector(".people-run")!.textContent).toContain("P07");
    expect(page.content.querySelector(".patient-item[aria-current]")!.textContent).toContain("P07");
    await tap(words.run.pause);
    expect(station.meant).toEqual([2]);
  });

  it("stays while its result is displayed or a note is being written, and the strip leads to the next one", async () => {
    await told({ phase: "trial", trial: 1 });
    page.content.querySelector<HTMLElement>(".people-run details")!.setAttribute("open", "");
    page.content.querySelector<HTMLTextAreaElement>(".people-run textarea")!.focus();
    await told({ number: 2, record: "aa", code: "P07", phase: "trial" });
    const strip = () => page.content.querySelector(".people-strip:not([hidden])");
    expect(page.content.querySelector(".people-run h2")!.textContent).toBe("P12");
    expect(page.content.querySelector(".people-run")!.getAttribute("data-stale")).toBe("true");
    expect(strip()!.textContent).toContain("P07");
    await tap(words.run.show);
    expect(page.content.querySelector(".people-run h2")!.textContent).toBe("P07");
    await told({ stage: "ended", phase: "done" });
    await told({ number: 3, record: "bb", code: "P12", stage: "running", phase: "ready" });
    expect(page.content.querySelector(".people-run h2")!.textContent).toBe("P07");
    expect(strip()!.textContent).toContain("P12");
  });

  it("asks for pain and tiredness at two places, so that one tap too many is not the other's answer", async () => {
    await told({ phase: "rating", asks: "pain" });
    const scales = () => [...page.content.querySelectorAll<HTMLElement>(".run-ratings")].map((one) => !one.hidden);
    expect(scales()).toEqual([true, false]);
    await told({ asks: "fatigue" });
    expect(scales()).toEqual([false, true]);
    await told({ asks: "", phase: "trial" });
    await tap(words.run.says);
    expect(scales()).toEqual([true, true]);
    await tap("7");
    expect(station.asked).toContain("input pain 7");
  });

  it("takes answers, a difficulty and a note, and ends after a second question", async () => {
    await told({ phase: "answer", choices: ["the first", "the second"] });
    await tap("The second one");
    await tap("75 %");
    const note = page.content.querySelector<HTMLTextAreaElement>(".people-run textarea")!;
    note.value = "slower now";
    note.closest("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    await tap(words.run.end);
    expect(station.asked).not.toContain("input abort");
    await tap(words.run.endNo);
    await tap(words.run.end);
    await tap(words.run.endYes);
    for (const one of ["input answer 2", "input difficulty 0.75", "note bb slower now", "input abort"]) expect(station.asked).toContain(one);
  });

  it("shows the result, and leads back to the patient", async () => {
    await told({ stage: "closing" });
    expect(shown()).toContain(words.run.stages["closing"]);
    await told({
      stage: "ended", phase: "done",
      result: { scores: [{ name: "mean_n", unit: "N", value: 2.2, origin: "measured", invalid: "" }], ended: "all trials are done", interrupted: false, repetitions: 8, successes: 6, counted: 8, seconds: 120, verdict: "" },
    });
    for (const text of ["mean: 2.2 N", words.run.facts("8", "2 min"), words.run.successes("6", "8")]) expect(shown()).toContain(text);
    expect(button(words.run.pause)).toBeUndefined();
    await tap(words.run.back("P12"));
    expect(page.content.querySelector(".people-patient")!.textContent).toContain(words.begin.title);
  });

  it("is left for another patient, and a strip leads back; a second one cannot begin", async () => {
    await told({ phase: "trial", trial: 1, trials: 5 });
    [...page.content.querySelectorAll<HTMLButtonElement>(".patient-item")][0]!.click();
    await flush();
    await next();
    expect(page.content.querySelector(".people-strip:not([hidden])")!.textContent).toContain("P12");
    page.content.querySelector<HTMLElement>(".begin-other .choice")!.click();
    [...page.content.querySelectorAll<HTMLElement>(".begin-other [role=option]")].at(-1)!.click();
    await tap(`${words.begin.begin}: ${words.begin.other}`);
    expect(page.content.querySelector(".confirm")).toBeNull();
    expect(shown()).toContain(words.begin.runs);
    await tap(words.run.show);
    expect(page.content.querySelector(".people-run")).not.toBeNull();
  });

  it("leaves the document with a lock, and is there again after it", async () => {
    await told({ phase: "trial", trial: 1, trials: 5 });
    page.lock();
    await next();
    expect(document.body.innerHTML).not.toContain("P12");
    page.content.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(page.content.querySelector(".people-run")!.textContent).toContain("P12");
  });

  it("is watched and paused while the page is locked, without a word of whose it is", async () => {
    const running = { phase: "trial", trial: 1, trials: 5, target: { kind: "force", digits: ["index"], low: 1.5, high: 2.5 }, value: 2, value_unit: "N", force: [0, 2, 0, 0, 0] };
    await told(running);
    page.content.querySelector<HTMLTextAreaElement>(".people-run textarea")!.value = "slower now";
    page.lock();
    await flush();
    const secret = /P12|slower now|right|sun/i;
    const watched = () => page.content.querySelector<HTMLElement>(".people-watched:not([hidden])");
    expect(document.body.innerHTML).not.toMatch(secret);
    for (const text of [words.run.trial("1", "5"), words.run.inBand, words.run.goal["force"]!]) expect(watched()!.textContent).toContain(text);
    for (const hidden of [words.run.skip, words.run.end, words.run.resume, words.run.start]) expect(button(hidden), hidden).toBeUndefined();
    station.locked = true; // the station has confirmed the lock
    await told({ ...running, trial: 2 });
    expect(watched()!.textContent).toContain(words.run.trial("2", "5"));
    await tap(words.run.pause);
    await told({ phase: "paused", forces_off: true });
    expect(watched()!.textContent).toContain(words.run.forcesOff);
    expect(shown()).toContain(words.lock.pauseSent);
    await tap(words.run.says);
    await tap("4");
    expect(station.asked.filter((one) => /^(input|watched .)/.test(one))).toEqual(["watched pause", "watched pain 4"]);
    expect(document.body.innerHTML).not.toMatch(secret);
    await told({ stage: "ended", phase: "done" });
    expect(watched()!.textContent).toContain(words.lock.ended);
    page.content.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    await next();
    expect(watched()).toBeNull();
    expect(shown()).toContain("P12");
  });

  it("is not shown on a lock's panel when none is under way, until one begins", async () => {
    await told({ stage: "ended", phase: "done" });
    page.lock();
    await flush();
    expect(page.content.querySelector(".people-watched:not([hidden])")).toBeNull();
    await told({ number: 2, stage: "running", phase: "trial", trial: 1, trials: 3 });
    expect(page.content.querySelector(".people-watched:not([hidden])")!.textContent).toContain(words.run.trial("1", "3"));
    expect(document.body.innerHTML).not.toMatch(/P12|P07/);
  });

  it("tells the locked page when a pause does not arrive, and when the session has ended", async () => {
    await told({ phase: "trial", trial: 1, trials: 5 });
    page.lock();
    await flush();
    Object.assign(station, { watchedInput: () => Promise.reject(new Error("no answer")) });
    await tap(words.run.pause);
    expect(shown()).toContain(words.lock.pauseFailed);
    station.signedIn = false;
    await next();
    expect(page.content.querySelector(".people-watched")!.textContent).toContain(words.lock.lost);
  });

  it("has the note that was being written again after the unlock", async () => {
    await told({ phase: "trial", trial: 1, trials: 5 });
    page.content.querySelector<HTMLTextAreaElement>(".people-run textarea")!.value = "slower now";
    page.lock();
    await flush();
    page.content.querySelector("form")!.dispatchEvent(new Event("submit", { cancelable: true }));
    await flush();
    expect(page.content.querySelector<HTMLTextAreaElement>(".people-run textarea")!.value).toBe("slower now");
  });

  it("is stale by time while a request still waits, on the panel and on the strip", async () => {
    await told({ phase: "trial", trial: 1 });
    Object.assign(station, { exercise: () => new Promise(() => undefined) });
    await next();
    time += 1900;
    expect(page.content.querySelector(".people-run")!.getAttribute("data-stale")).toBe("false");
    time += 200;
    await next();
    expect(page.content.querySelector(".people-run")!.getAttribute("data-stale")).toBe("true");
    [...page.content.querySelectorAll<HTMLButtonElement>(".patient-item")][0]!.click();
    await flush();
    const strip = page.content.querySelector(".people-strip:not([hidden])")!;
    expect([...strip.querySelectorAll<HTMLElement>(".refused")].map((one) => one.hidden)).toEqual([false]);
  });

  it("says when the station does not answer, and goes on by itself", async () => {
    await told({ phase: "trial" });
    const before = station.exercise;
    Object.assign(station, { exercise: () => Promise.reject(new Error("gone")) });
    for (let i = 0; i < 3; ++i) {
      time += 1000;
      await next();
    }
    const stale = () => [...page.content.querySelectorAll<HTMLElement>(".people-run > .refused")].find((one) => one.textContent === words.run.stale)!;
    expect(stale().hidden).toBe(false);
    Object.assign(station, { exercise: before });
    await next();
    expect(stale().hidden).toBe(true);
  });
});

describe("an answer about the exercise", () => {
  it.each([null, 7, "x", [], {}, { stage: "flying", phase: 3, target: [], result: "none", force: "x", choices: [1] }])("is read without a failure, whatever it is: %j", (answer) => {
    expect(readExerciseNow(answer)).toMatchObject({ stage: "none", phase: "ready", result: undefined, forces: [], choices: [] });
  });
});
