// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FaultSchema, StateSchema, ToPageSchema, WelcomeSchema, WizardSchema, type State } from "../../../src/gen/phalanx/cockpit_pb";
import { SafetyState } from "../../../src/gen/phalanx/tick_pb";
import type { App } from "../../../src/panels/app";
import { faultCard } from "../../../src/panels/fault_card";
import { onPress } from "../../../src/panels/press";
import { stopBox } from "../../../src/panels/stop_box";
import { troubleCard } from "../../../src/panels/trouble_card";
import { kStateStaleMs, Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";
import { kProtocol } from "../../../src/wire/connection";
import type { Host } from "../../../src/wire/host";
import { kStopAgainMs } from "../../../src/wire/stop_order";

let store: Store;
let app: App;
let confirms = false;
let refuse = "";
const said = { stop: 0, resume: [] as bigint[], reset: [] as number[] };

beforeEach(() => {
  vi.useFakeTimers();
  Object.assign(said, { stop: 0, resume: [], reset: [] });
  confirms = false;
  refuse = "";
  store = new Store();
  const answer = () => Promise.resolve({ ok: refuse === "", error: refuse });
  const host = {
    stop: () => (++said.stop, Promise.resolve(confirms)),
    resume: (stops: bigint) => (said.resume.push(stops), answer()),
    reset: (time: number) => (said.reset.push(time), answer()),
  } as unknown as Host;
  app = { store, host, dialogs: document.createElement("div"), takeControl: () => {}, upload: () => Promise.reject(new Error("none")) };
  connect();
});
afterEach(() => vi.useRealTimers());

function connect(): void {
  store.setPhase("open");
  store.receive(create(ToPageSchema, { what: { case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, page: 2, mayOperate: true }) } }));
}
function state(what: Partial<State>): void {
  store.receive(create(ToPageSchema, { what: { case: "state", value: create(StateSchema, { operatorPage: 2, safety: SafetyState.SAFETY_RUNNING, ...what } as State) } }));
}
const held = (stops: bigint) => state({ heldStopped: true, safety: SafetyState.SAFETY_STOPPED, stops });
const words = (element: HTMLElement) => element.querySelector(".stop-said:not([hidden])")?.textContent ?? "";
const named = (element: HTMLElement, text: string) => [...element.querySelectorAll("button")].find((one) => one.textContent === text)!;
const flush = () => vi.advanceTimersByTimeAsync(0);

describe("a calibration", () => {
  it("rests the station: Resume comes back with its end", () => {
    const { element } = stopBox(app);
    const resume = named(element, strings.stop.resume);
    held(1n);
    expect(resume.hidden).toBe(false);
    state({ heldStopped: true, stationGone: true, stops: 1n, wizard: create(WizardSchema, { name: ["flat hand"] }) });
    expect(resume.hidden).toBe(true);
    held(1n);
    expect(resume.hidden).toBe(false);
  });
});

describe("a stop that is not confirmed", () => {
  it("is said again every second, and with the next welcome, until the station has it", async () => {
    const box = stopBox(app);
    state({});
    store.setPhase("waiting");
    box.stop();
    await flush();
    expect(said.stop).toBe(1);
    expect(words(box.element)).toBe(strings.stop.failed);
    await vi.advanceTimersByTimeAsync(3 * kStopAgainMs);
    expect(said.stop).toBe(4);
    connect();
    expect(said.stop).toBe(5);
    confirms = true;
    await vi.advanceTimersByTimeAsync(kStopAgainMs);
    held(1n);
    expect(words(box.element)).toBe("");
    await vi.advanceTimersByTimeAsync(10 * kStopAgainMs);
    expect(said.stop).toBe(6);
  });

  it("is confirmed by a State that counts it, not by one that was on its way", async () => {
    const box = stopBox(app);
    held(4n);
    box.stop();
    await flush();
    held(4n);
    expect(words(box.element)).toBe(strings.stop.failed);
    held(5n);
    expect(words(box.element)).toBe("");
    await vi.advanceTimersByTimeAsync(10 * kStopAgainMs);
    expect(said.stop).toBe(1);
  });

  it("once confirmed says nothing of now: what is not known is said so, and a resume takes the words away", async () => {
    const box = stopBox(app);
    state({});
    confirms = true;
    store.setPhase("waiting");
    box.stop();
    await flush();
    expect(words(box.element)).toContain("not known");
    connect();
    state({ stops: 1n });
    expect(words(box.element)).toBe("");
    store.setPhase("waiting");
    expect(words(box.element)).toBe("");
  });
});

describe("the stop box", () => {
  it("says Not known of a station that has fallen silent, though the line stands", async () => {
    const box = stopBox(app);
    state({});
    expect(box.element.textContent).toContain(strings.safety.running);
    await vi.advanceTimersByTimeAsync(kStateStaleMs + 1);
    box.update();
    expect(box.element.dataset["state"]).toBe("unknown");
    expect(box.element.textContent).toContain(strings.safety.unknown);
  });

  it("resumes what it shows, and says beside the button why not", async () => {
    const box = stopBox(app);
    held(3n);
    refuse = "somebody has said stop since";
    named(box.element, strings.stop.resume).click();
    await flush();
    expect(said.resume).toEqual([3n]);
    expect(box.element.querySelector(".refused:not([hidden])")?.textContent).toBe(refuse);
    state({ stops: 3n });
    expect(box.element.querySelector(".refused:not([hidden])")).toBeNull();
  });
});

describe("one press", () => {
  const press = (type: string, init: PointerEventInit & { detail?: number } = {}) => new PointerEvent(type, { bubbles: true, button: 0, detail: 1, ...init });

  it("acts as the finger goes down, once; Enter and assistive technology click", () => {
    const act = vi.fn();
    const button = document.createElement("button");
    document.body.append(button);
    onPress(button, act);
    button.dispatchEvent(press("pointerdown"));
    expect(act).toHaveBeenCalledTimes(1);
    button.dispatchEvent(press("pointerup"));
    button.dispatchEvent(press("click"));
    expect(act).toHaveBeenCalledTimes(1);
    button.dispatchEvent(press("pointerdown", { button: 2 }));
    expect(act).toHaveBeenCalledTimes(1);
    button.dispatchEvent(press("pointerdown"));
    button.dispatchEvent(press("click", { detail: 0 }));
    expect(act).toHaveBeenCalledTimes(3);
    button.dispatchEvent(press("click", { detail: 1 }));
    expect(act).toHaveBeenCalledTimes(4);
  });

  it("whose finger slid away takes no later click along", () => {
    const act = vi.fn();
    const button = document.createElement("button");
    document.body.append(button);
    onPress(button, act);
    button.dispatchEvent(press("pointerdown"));
    document.body.dispatchEvent(press("pointerup"));
    vi.advanceTimersByTime(1000);
    button.dispatchEvent(press("click"));
    expect(act).toHaveBeenCalledTimes(2);
  });
});

describe("the way back", () => {
  it("from no station: says why, and tries again for who operates", async () => {
    const card = troubleCard(app);
    const gone = { stationGone: true, trouble: "no device at /dev/ttyACM0" };
    state(gone);
    expect(card.hidden).toBe(false);
    expect(card.textContent).toContain(gone.trouble);
    named(card, strings.gone.again).click();
    await flush();
    expect(said.reset).toEqual([0]);
    state({ ...gone, busy: "a new station" });
    expect(card.hidden).toBe(true);
    state({ ...gone, operatorPage: 3 });
    expect(named(card, strings.gone.again).disabled).toBe(true);
    state({});
    expect(card.hidden).toBe(true);
  });

  it("from a fault: resets the one that is shown", async () => {
    const card = faultCard(app);
    state({ fault: create(FaultSchema, { name: "sensor_lost", time: 12.25 }) });
    named(card, strings.fault.reset).click();
    await flush();
    expect(said.reset).toEqual([12.25]);
  });
});
