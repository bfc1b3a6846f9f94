// SPDX-License-Identifier: Apache-2.0
import { expect, it, vi } from "vitest";
import { viewFrame } from "../../../src/panels/view_frame";
import { strings } from "../../../src/strings";
import { fakeApp, kMe } from "./fake_app";

vi.mock("../../../src/view3d/view", () => ({
  createHandView: () => {
    throw new Error("broken");
  },
}));

it("a view that cannot be loaded is named, with a way to try again", async () => {
  const report = vi.spyOn(console, "error").mockImplementation(() => {});
  const frame = viewFrame(fakeApp().store, []);
  const wait = frame.element.querySelector<HTMLElement>(".view-wait")!;
  const reload = wait.querySelector("button")!;
  expect([wait.hidden, wait.querySelector("p")!.textContent, reload.hidden]).toEqual([false, strings.view.loading, true]);
  await frame.load("dark");
  expect([wait.hidden, wait.querySelector("p")!.textContent, reload.hidden]).toEqual([false, strings.view.notLoaded, false]);
  expect(report).toHaveBeenCalledOnce();
  report.mockRestore();
});

it("friction cones and the key of a slip are offered where contacts slide, and cones begin switched off", () => {
  const fake = fakeApp();
  const { element } = viewFrame(fake.store, []);
  const control = [...element.querySelectorAll<HTMLElement>("[role=switch]")].find((one) => one.textContent === strings.view.parts.cones)!;
  const key = element.querySelector<HTMLElement>(".slip-key")!;
  const shown = () => [control, key].map((one) => !one.hidden);
  expect(shown()).toEqual([false, false]);
  fake.operate(kMe, [["contact.mode", '"sliding"']]);
  expect(shown()).toEqual([true, true]);
  expect(control.getAttribute("aria-checked")).toBe("false");
  control.click();
  expect(control.getAttribute("aria-checked")).toBe("true");
  fake.operate(kMe, [["contact.mode", '"static"']]);
  expect(shown()).toEqual([false, false]);
});
