// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it, vi } from "vitest";
import { ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { expertPanel } from "../../../src/panels/expert_panel";
import type { OwnObject } from "../../../src/panels/own_object";
import { strings } from "../../../src/strings";
import { kProtocol } from "../../../src/wire/connection";
import { fakeApp, kMe } from "./fake_app";

it("a scene that is refused stays chosen; while one is asked for, no other is", async () => {
  const fake = fakeApp();
  const scene = ["press_teapot", "pinch_ball"].map((name) => ({ name }));
  fake.store.receive(create(ToPageSchema, { what: { case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: true, scene }) } }));
  const state = () => fake.state({ operatorPage: kMe, scene: "press_teapot" });
  state();
  const panel = expertPanel(fake.app, { open: () => {} } as unknown as OwnObject);
  document.body.replaceChildren(panel);
  const box = panel.querySelector<HTMLButtonElement>(`[role=combobox][aria-label="${strings.scene.label}"]`)!;
  const load = [...panel.querySelectorAll("button")].find((one) => one.textContent === strings.scene.load)!;
  box.click();
  panel.querySelector<HTMLElement>("[data-value=pinch_ball]")!.click();
  expect(load.disabled).toBe(false);
  fake.refuse = "the station is busy";
  load.click();
  state();
  expect(load.disabled).toBe(true);
  await vi.waitFor(() => expect(panel.textContent).toContain(fake.refuse));
  expect([load.disabled, box.textContent]).toEqual([false, "pinch_ball"]);
  fake.refuse = "";
  load.click();
  await vi.waitFor(() => expect(box.textContent).toBe("press_teapot")); // until the station has loaded the other
  expect(fake.loaded).toEqual(["pinch_ball", "pinch_ball"]);
});
