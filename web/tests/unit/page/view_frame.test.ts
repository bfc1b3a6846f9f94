// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { viewFrame } from "../../../src/panels/view_frame";
import { strings } from "../../../src/strings";
import { fakeApp, kMe } from "./fake_app";

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
