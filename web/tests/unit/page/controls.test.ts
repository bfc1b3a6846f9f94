// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { StateSchema, ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import type { App } from "../../../src/panels/app";
import { fist, WantedAngles } from "../../../src/panels/joint_sliders";
import { barHeights, duration, usedOctaves } from "../../../src/panels/histogram";
import { fromScale, guarded, logSliderRow, toScale } from "../../../src/panels/setting_controls";
import { stabiliserInForce, touchPanel } from "../../../src/panels/touch_panel";
import { valueRange } from "../../../src/plots/chart";
import { Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";
import type { Change, Host } from "../../../src/wire/host";

const stiffness = "force.stiffness_n_per_mm";
let store: Store;
let app: App;
let asked: (readonly Change[])[] = [];
let refuse = "";

function operate(page: number, values: readonly (readonly [string, string])[] = []): void {
  store.receive(create(ToPageSchema, { what: { case: "state", value: create(StateSchema, { operatorPage: page, value: values.map(([key, value]) => ({ key, value })) }) } }));
}

beforeEach(() => {
  vi.useFakeTimers();
  asked = [];
  refuse = "";
  store = new Store();
  store.setPhase("open");
  const key = [
    { path: stiffness, type: "number", range: ">= 0, <= 100", defaultValue: "0.5" },
    { path: "stabiliser.method", type: "choice", range: "none, smoothing, low_pass", defaultValue: '"smoothing"' },
    { path: "smoothing.enabled", type: "flag", range: "true, false", defaultValue: "true" },
  ];
  store.receive(create(ToPageSchema, { what: { case: "welcome", value: create(WelcomeSchema, { protocol: 1, page: 2, mayOperate: true, key }) } }));
  const host = {
    set: (changes: readonly Change[]) => {
      asked.push(changes);
      return Promise.resolve({ ok: refuse === "", error: refuse, text: "" });
    },
  } as unknown as Host;
  app = { store, host, dialogs: document.createElement("div"), takeControl: () => {}, upload: () => Promise.reject(new Error("none")) };
});
afterEach(() => vi.useRealTimers());

const slider = () => logSliderRow(app, stiffness, { label: "Stiffness", field: "Number", unit: "N/mm", low: "soft", high: "stiff" }, 0.1, 5);

describe("controls", () => {
  it("are usable on the page that has control, and on no other", () => {
    const fieldset = guarded(app);
    expect(fieldset.disabled).toBe(true);
    operate(2);
    expect(fieldset.disabled).toBe(false);
    operate(3);
    expect(fieldset.disabled).toBe(true);
    operate(2);
    store.setPhase("waiting");
    expect(fieldset.disabled).toBe(true);
  });

  it("a dragged slider sends at most ten changes a second, and the last one", async () => {
    operate(2);
    const range = slider().querySelector<HTMLInputElement>("input[type=range]")!;
    for (let i = 0; i <= 100; ++i) {
      range.value = String(10 * i);
      range.dispatchEvent(new Event("input"));
      await vi.advanceTimersByTimeAsync(10);
    }
    range.dispatchEvent(new Event("change"));
    await vi.advanceTimersByTimeAsync(500);
    expect(asked.length).toBeLessThanOrEqual(12);
    expect(asked.at(-1)).toEqual([[stiffness, "5"]]);
  });

  it("what is refused is said in the host's words, and the control goes back to the truth", async () => {
    operate(2, [[stiffness, "0.7"]]);
    const element = slider();
    const field = element.querySelector<HTMLInputElement>("input[type=text]")!;
    refuse = "beyond its range";
    field.value = "900";
    field.dispatchEvent(new Event("input"));
    field.dispatchEvent(new Event("change"));
    await vi.advanceTimersByTimeAsync(300);
    expect(asked).toEqual([[[stiffness, "900"]]]);
    expect(element.querySelector(".refused")?.textContent).toBe("beyond its range");
    expect(field.value).toBe("0.7");
  });

  it("smoothing off is no stabiliser, and choosing one switches it on", async () => {
    operate(2, [["smoothing.enabled", "false"], ["stabiliser.method", '"smoothing"']]);
    expect(stabiliserInForce(app)).toBe("none");
    const panel = touchPanel(app);
    document.body.replaceChildren(panel);
    const box = panel.querySelector<HTMLButtonElement>(`[role=combobox][aria-label="${strings.calm.method}"]`)!;
    expect(box.textContent).toBe(strings.calm.methods["none"]);
    const choose = (value: string) => {
      box.click();
      document.getElementById(box.getAttribute("aria-controls")!)!.querySelector<HTMLElement>(`[data-value=${value}]`)!.click();
    };
    choose("low_pass");
    choose("none");
    const smoothing = panel.querySelector<HTMLButtonElement>(`[role=switch][aria-label="${strings.calm.smoothing}"]`)!;
    smoothing.click();
    await vi.advanceTimersByTimeAsync(10);
    expect(asked).toEqual([
      [["smoothing.enabled", "true"], ["stabiliser.method", '"low_pass"']],
      [["stabiliser.method", '"smoothing"'], ["smoothing.enabled", "false"]],
      [["smoothing.enabled", "true"]],
    ]);
  });

  it("the stiffness scale is logarithmic and goes there and back", () => {
    expect(fromScale(0, 0.1, 5)).toBeCloseTo(0.1, 12);
    expect(fromScale(1, 0.1, 5)).toBeCloseTo(5, 12);
    expect(fromScale(0.5, 0.1, 5)).toBeCloseTo(Math.sqrt(0.5), 12);
    for (const value of [0.1, 0.3, 1, 4.9]) expect(fromScale(toScale(value, 0.1, 5), 0.1, 5)).toBeCloseTo(value, 12);
    expect(toScale(50, 0.1, 5)).toBe(1);
  });

  it("the smoothing switch speaks of smoothing alone: another stabiliser blocks it, and says so", async () => {
    const shown = () => {
      const control = panel.querySelector<HTMLButtonElement>(`[role=switch][aria-label="${strings.calm.smoothing}"]`)!;
      return [control.getAttribute("aria-checked"), control.disabled, panel.textContent!.includes(strings.calm.smoothingOther)];
    };
    const panel = touchPanel(app);
    const stabiliser = (method: string, enabled = "true") => operate(2, [["stabiliser.method", `"${method}"`], ["smoothing.enabled", enabled]]);
    stabiliser("smoothing");
    expect(shown()).toEqual(["true", false, false]);
    stabiliser("rise_only");
    expect(shown()).toEqual(["true", false, false]);
    stabiliser("low_pass");
    expect(shown()).toEqual(["false", true, true]);
    stabiliser("none");
    expect(shown()).toEqual(["false", false, false]);
    panel.querySelector<HTMLButtonElement>(`[role=switch][aria-label="${strings.calm.smoothing}"]`)!.click();
    await vi.advanceTimersByTimeAsync(10);
    expect(asked).toEqual([[["smoothing.enabled", "true"], ["stabiliser.method", '"smoothing"']]]);
  });

  it("a drag ends where the finger leaves, or with control", async () => {
    operate(2, [[stiffness, "0.5"]]);
    const range = slider().querySelector<HTMLInputElement>("input[type=range]")!;
    const before = range.value;
    for (const end of ["pointerup", "pointercancel", "blur"]) {
      range.value = "900";
      range.dispatchEvent(new Event("input"));
      range.dispatchEvent(new Event(end));
      await vi.advanceTimersByTimeAsync(3000);
      operate(2, [[stiffness, "0.5"]]);
      expect(range.value, end).toBe(before);
    }
    const count = asked.length;
    range.value = "900";
    range.dispatchEvent(new Event("input"));
    range.value = "950";
    range.dispatchEvent(new Event("input")); // waits for its turn
    operate(3, [[stiffness, "0.5"]]);
    await vi.advanceTimersByTimeAsync(3000);
    operate(2, [[stiffness, "0.5"]]);
    expect(range.value).toBe(before);
    expect(asked.length).toBeLessThanOrEqual(count + 1);
  });
});

describe("sliders of joints", () => {
  it("send for joints that nobody holds what the station says", () => {
    let now = 0;
    const wanted = new WantedAngles(() => now);
    const station = new Array<number>(20).fill(0.1);
    wanted.want(3, 0.9);
    expect(wanted.angles(station)[3]).toBe(0.9);
    station[5] = 0.7;
    expect(wanted.angles(station)[5]).toBe(0.7);
    wanted.sent(new Set([3]));
    now += 60_000;
    expect(wanted.angles(station)[3], "still held").toBe(0.9);
    wanted.sent(new Set());
    now += 500;
    expect(wanted.angles(station)[3], "the station may not have said it yet").toBe(0.9);
    now += 1000;
    expect(wanted.angles(station)).toEqual(station);
    wanted.want(3, 0.9);
    wanted.forget();
    expect(wanted.angles(station)).toEqual(station);
  });
});

describe("figures", () => {
  it("a fist flexes and does not spread", () => {
    const open = new Array<number>(20).fill(0.1);
    const max = new Array<number>(20).fill(1.1);
    const made = fist(open, max);
    expect(made[0]).toBeCloseTo(0.9, 12);
    expect(made[1]).toBe(0.1);
    expect(made[19]).toBeCloseTo(0.9, 12);
  });

  it("durations are read in their own unit", () => {
    expect([duration(0.1), duration(88.44), duration(1210), duration(3.3e6), duration(NaN)]).toEqual(["0.1 µs", "88.4 µs", "1.21 ms", "3.3 s", "–"]);
  });

  it("one late step among a million still has a bar", () => {
    const counts = [0n, 1_000_000n, 0n, 1n, 0n];
    expect(usedOctaves(counts)).toEqual([1, 3]);
    expect(usedOctaves([0n, 0n])).toBeNull();
    const heights = barHeights(counts);
    expect(heights[1]).toBe(1);
    expect(heights[2]).toBe(0);
    expect(heights[3]).toBeGreaterThan(0.1);
  });

  it("a plot's axis holds zero and all values, and is never too narrow", () => {
    expect(valueRange("force", 0, 0.01)[1]).toBeGreaterThanOrEqual(1);
    expect(valueRange("force", 0, 4)[0]).toBe(0);
    const [low, high] = valueRange("torque", -0.3, 0.1);
    expect(low).toBeLessThan(-0.3);
    expect(high).toBeGreaterThan(0.1);
    expect(valueRange("angle", null, null)[1]).toBeGreaterThanOrEqual(10);
  });
});
