// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { optionsOf } from "../../../src/patient/options";
import { PatientPage, type PageActs } from "../../../src/patient/page";
import { kDeafMs } from "../../../src/patient/rating";
import { nothingKnown } from "../../../src/patient/state";
import type { ExerciseNow } from "../../../src/patient/game";
import type { Answer } from "../../../src/wire/connection";
import { en } from "../../../src/strings/patient_en";
import { exerciseNow, knownWith } from "./exercise";

const gone = { ok: false, error: "" };
const good = { ok: true, error: "" };
let answer: Answer = good;
const pause = vi.fn(() => Promise.resolve(answer));
const rate = vi.fn<PageActs["rate"]>(() => Promise.resolve(answer));
let page: PatientPage;
const one = <T extends HTMLElement = HTMLElement>(selector: string) => page.element.querySelector<T>(selector)!;
const said = () => (one(".bar-said").hidden ? "" : one(".bar-said").textContent);
const facesOpen = () => !one(".rating").hidden;
const screen = () => page.element.dataset["screen"];
const settled = () => vi.advanceTimersByTimeAsync(0);
const face = (value: number) => one<HTMLButtonElement>(`.face-button[data-value="${value}"]`).click();
const show = (changes: Partial<ExerciseNow> = {}) => page.take(knownWith(exerciseNow(changes)));

beforeEach(() => {
  vi.useFakeTimers();
  answer = good;
  vi.spyOn(console, "error").mockImplementation(() => {}); // three.js reports that there is no graphics card
  page = new PatientPage({ stop: () => {}, pause, rate, chosen: () => {} }, { ...optionsOf(""), speech: false, sound: false }, nothingKnown);
});
afterEach(() => {
  vi.clearAllMocks();
  vi.useRealTimers();
});

describe("a break that the patient asks for", () => {
  const paused = (stops: number) => page.take(knownWith(exerciseNow({ phase: "paused" }), { stopped: true, stops }));
  const goal = () => one(".goal h1").textContent;
  beforeEach(async () => {
    show();
    one(".bar-pause").click();
    await settled();
    paused(3);
  });

  it("is called a break, although the station holds the torque at zero as after a stop", async () => {
    paused(4); // the exercise stops once more
    expect(goal()).toBe(en.screen.paused);
    await vi.advanceTimersByTimeAsync(60_000);
    paused(4);
    expect(goal()).toBe(en.screen.paused);
  });

  it("is none any more after another stop, nor after it has ended", async () => {
    await vi.advanceTimersByTimeAsync(2000);
    paused(4);
    expect(goal()).toBe(en.screen.stopped);
    show();
    paused(4);
    expect(goal()).toBe(en.screen.stopped);
  });

  it("is none after the patient's STOP, and in a fault the fault is said", () => {
    page.take(knownWith(exerciseNow({ phase: "paused" }), { stopped: true, stops: 3, fault: true }));
    expect(goal()).toBe(en.screen.fault);
    page.stopping("sent");
    paused(3);
    expect(goal()).toBe(en.screen.stopped);
  });

  it("is not begun by a tap while the exercise is stopped", async () => {
    await vi.advanceTimersByTimeAsync(2000);
    paused(5);
    one(".bar-pause").click();
    await settled();
    paused(6);
    expect(goal()).toBe(en.screen.stopped);
  });
});

describe("a tap on pain or tired", () => {
  it("begins a break unless it is known that nothing presses", () => {
    const pressed = (known: Parameters<PatientPage["take"]>[0]) => {
      page.take(known);
      pause.mockClear();
      one(".bar-pain").click();
      return pause.mock.calls.length;
    };
    expect(pressed(nothingKnown), "nothing is known").toBe(1);
    expect(pressed(knownWith(undefined)), "forces without an exercise").toBe(1);
    for (const phase of ["warm_up", "rest", "trial", "answer"] as const) expect(pressed(knownWith(exerciseNow({ phase }))), phase).toBe(1);
    for (const phase of ["ready", "rating", "paused", "done"] as const) {
      expect(pressed(knownWith(exerciseNow({ phase }))), phase).toBe(0);
      expect(pressed(knownWith(exerciseNow({ phase }), { connected: "waiting" })), `${phase}, a lost connection`).toBe(1);
      expect(pressed(knownWith(exerciseNow({ phase, stage: "ended" }))), `${phase}, ended`).toBe(1);
    }
  });

  it("opens faces that end with the break", () => {
    show();
    one(".bar-pain").click();
    expect(facesOpen()).toBe(true);
    show({ phase: "paused" });
    expect(facesOpen()).toBe(true);
    show({ phase: "trial" });
    expect([facesOpen(), screen()]).toEqual([false, "play"]);
  });

  it("opens faces that end with the exercise, its stage, a phase without forces and the connection", () => {
    const opened = (first: Partial<ExerciseNow>) => {
      show(first);
      one(".bar-tired").click();
      expect(facesOpen()).toBe(true);
    };
    opened({});
    show({ number: 2 });
    expect(facesOpen()).toBe(false);
    opened({ number: 2 });
    show({ number: 2, stage: "closing", phase: "done" });
    expect(facesOpen()).toBe(false);
    opened({ number: 3, phase: "ready" });
    show({ number: 3, phase: "warm_up" });
    expect(facesOpen()).toBe(false);
    opened({ number: 4 });
    page.take(knownWith(exerciseNow({ number: 4 }), { connected: "waiting" }));
    expect([facesOpen(), screen()]).toEqual([false, "wait"]);
    one(".bar-pain").click();
    expect(facesOpen(), "no face can be sent without a connection").toBe(false);
  });

  it("comes before the station's question, and returns to it", async () => {
    show({ phase: "rating", asks: "pain" });
    one(".bar-tired").click();
    expect(one(".rating").getAttribute("aria-label")).toBe(en.rating.tired);
    expect(one(".rating-title").hidden).toBe(false);
    await vi.advanceTimersByTimeAsync(kDeafMs);
    face(6);
    expect(rate).toHaveBeenLastCalledWith("tired", 6);
    expect(one(".rating").getAttribute("aria-label")).toBe(en.rating.pain);
    expect(one(".goal").hidden).toBe(false);
  });

  it("closes the menu, as a change of phase does", () => {
    show();
    one(".menu-opener").click();
    expect(one(".menu").hidden).toBe(false);
    one(".bar-pain").click();
    expect(one(".menu").hidden).toBe(true);
    one(".menu-opener").click();
    show({ phase: "paused" });
    expect(one(".menu").hidden).toBe(true);
  });
});

describe("a face", () => {
  it("is not heard just after the question has changed, nor a second time", async () => {
    show({ phase: "rating", asks: "pain" });
    face(2);
    expect(rate).not.toHaveBeenCalled();
    await vi.advanceTimersByTimeAsync(kDeafMs);
    face(2);
    face(4);
    expect(rate.mock.calls).toEqual([["pain", 2]]);
    await vi.advanceTimersByTimeAsync(kDeafMs);
    show({ phase: "rating", asks: "tired" });
    face(4);
    expect(rate.mock.calls).toHaveLength(1);
    await vi.advanceTimersByTimeAsync(kDeafMs);
    face(4);
    expect(rate.mock.lastCall).toEqual(["tired", 4]);
  });
});

describe("the bar", () => {
  it("says that the break begins only when the station has taken it", async () => {
    show();
    one(".bar-pause").click();
    expect(said()).toBe("");
    await settled();
    expect(said()).toBe(en.sent.pause);
    vi.advanceTimersByTime(5000);
    page.frame(0.03);
    expect(said()).toBe("");
  });

  it("says what becomes of the STOP that was sent in place of a break that failed", async () => {
    show();
    answer = gone;
    one(".bar-pause").click();
    page.stopping("sent");
    await settled();
    expect(said()).toBe(en.sent.stop);
    page.stopping("owed");
    expect(said()).toBe(en.sent.owed);
  });

  it("shows an owed STOP again when something said for a time ends", async () => {
    show({ phase: "rating", asks: "pain" });
    page.stopping("owed");
    await vi.advanceTimersByTimeAsync(kDeafMs);
    face(2);
    await settled();
    expect(said()).toBe(en.sent.thanks);
    vi.advanceTimersByTime(5000);
    page.frame(0.03);
    expect(said()).toBe(en.sent.owed);
    page.stopping("confirmed");
    expect(said()).toBe(en.sent.stopped);
    vi.advanceTimersByTime(5000);
    page.frame(0.03);
    expect(said()).toBe("");
  });
});

describe("a sign-in that is missing", () => {
  it("is said in the bar during an exercise, which goes on", () => {
    show();
    page.signIn.refused();
    expect([screen(), said(), one(".sign-in").hidden]).toEqual(["play", en.sent.signIn, true]);
    one(".bar-pain").click();
    expect(facesOpen()).toBe(true);
    show({ stage: "ended", phase: "done" });
    expect([screen(), said(), one(".sign-in").hidden]).toEqual(["sign_in", "", false]);
  });

  it("can be put off, and opened from the menu", () => {
    page.take(knownWith(undefined));
    page.signIn.refused();
    expect(screen()).toBe("sign_in");
    one(".sign-in-later").click();
    expect(screen()).toBe("greet");
    show({ phase: "paused" });
    expect(one(".menu-sign-in").hidden).toBe(false);
    one(".menu-sign-in").click();
    expect(screen()).toBe("sign_in");
    show({ phase: "trial" });
    expect(screen(), "the trial is not covered").toBe("play");
  });
});

describe("a game that fails", () => {
  it("ends, and leaves words and buttons", () => {
    const report = vi.mocked(console.error);
    show();
    report.mockClear();
    expect(one(".game").childElementCount).toBe(1);
    const broken = { ...exerciseNow(), get target(): never { throw new Error("no target"); } } as unknown as ExerciseNow;
    Object.assign(page, { known: knownWith(broken) });
    for (let frame = 0; frame < 3; ++frame) page.frame(0.03);
    expect(report).toHaveBeenCalledTimes(1);
    expect(one(".game").childElementCount).toBe(0);
    show({ progress: 0.5 });
    expect(one(".game").childElementCount, "not once more in this exercise").toBe(0);
    expect(one("h1").textContent).not.toBe("");
    show({ number: 2 });
    expect(one(".game").childElementCount).toBe(1);
  });
});
