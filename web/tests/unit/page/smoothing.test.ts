// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { expertPanel } from "../../../src/panels/expert_panel";
import { smoothingSwitch, stabiliserInForce } from "../../../src/panels/smoothing";
import { el } from "../../../src/panels/dom";
import { strings } from "../../../src/strings";
import { fakeApp, type FakeApp } from "./fake_app";

let fake: FakeApp;
beforeEach(() => {
  vi.useFakeTimers();
  fake = fakeApp();
});
afterEach(() => vi.useRealTimers());

describe("smoothing", () => {
  it("off is no stabiliser; the switch and the list of experts set the method alone", async () => {
    fake.operate(2, [["stabiliser.method", '"none"']]);
    expect(stabiliserInForce(fake.app)).toBe("none");
    const panel = el("div", {}, expertPanel(fake.app, { open: () => {} }), smoothingSwitch(fake.app));
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
    expect(fake.asked).toEqual([
      [["stabiliser.method", '"low_pass"']],
      [["stabiliser.method", '"none"']],
      [["stabiliser.method", '"rise_only"']],
    ]);
  });

  it("is the papers' where the scene bounds the fall", async () => {
    for (const bound of ["smoothing.min_n_per_s", "smoothing.min_n"]) {
      fake = fakeApp();
      const panel = smoothingSwitch(fake.app);
      fake.operate(2, [["stabiliser.method", '"none"'], [bound, "-10"]]);
      panel.querySelector<HTMLButtonElement>(`[role=switch][aria-label="${strings.calm.smoothing}"]`)!.click();
      await vi.advanceTimersByTimeAsync(10);
      expect(fake.asked).toEqual([[["stabiliser.method", '"smoothing"']]]);
    }
  });

  it("shows the bound on the fall only where the method has one", () => {
    const panel = expertPanel(fake.app, { open: () => {} });
    const shown = () => {
      const labels = [...panel.querySelectorAll<HTMLElement>("label")].filter((one) => one.textContent === strings.calm.fall);
      expect(labels.length).toBe(1);
      return labels[0]!.closest("[hidden]") === null;
    };
    fake.operate(2, [["stabiliser.method", '"smoothing"']]);
    expect(shown()).toBe(true);
    fake.operate(2, [["stabiliser.method", '"rise_only"']]);
    expect(shown()).toBe(false);
  });

  it("has a switch that speaks of it alone: another stabiliser blocks it, and says so", async () => {
    const shown = () => {
      const control = panel.querySelector<HTMLButtonElement>(`[role=switch][aria-label="${strings.calm.smoothing}"]`)!;
      return [control.getAttribute("aria-checked"), control.disabled, panel.textContent!.includes(strings.calm.smoothingOther)];
    };
    const panel = smoothingSwitch(fake.app);
    const stabiliser = (method: string) => fake.operate(2, [["stabiliser.method", `"${method}"`]]);
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
    expect(fake.asked).toEqual([[["stabiliser.method", '"rise_only"']]]);
  });
});
