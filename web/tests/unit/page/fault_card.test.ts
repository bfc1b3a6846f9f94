// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { calibrationDialog } from "../../../src/panels/calibration_dialog";
import { devicePanel } from "../../../src/panels/device_panel";
import { faultCard, faultSection } from "../../../src/panels/fault_card";
import { strings } from "../../../src/strings";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

const words = strings.fault;
const fault = { name: "sensor_jump", meaning: "A sensor's angle jumped.", remedy: "Check its cable.", channel: 7, time: 12.5, report: "out/faults/1.json" };
let fake: FakeApp;
const resetOf = (element: HTMLElement) => [...element.querySelectorAll("button")].find((one) => one.textContent === words.reset)!;

beforeEach(() => (fake = fakeApp()));

describe("a fault", () => {
  it("is told over the view and in the device panel, with what to do", () => {
    const places = [faultCard(fake.app), faultSection(fake.app)];
    fake.state({ operatorPage: kMe, fault });
    for (const place of places) {
      for (const text of [fault.meaning, fault.remedy, fault.report, words.channel(7), "sensor jump"]) expect(place.textContent).toContain(text);
    }
    expect(devicePanel(fake.app, calibrationDialog(fake.app, () => {})).textContent).toContain(fault.meaning);
  });

  it("is reset from either place, and what is refused is said there", async () => {
    for (const place of [faultCard(fake.app), faultSection(fake.app)]) {
      fake.state({ operatorPage: kMe, fault });
      fake.refuse = "the cause is still there";
      resetOf(place).click();
      await Promise.resolve().then(() => {});
      expect(fake.resets.at(-1)).toBe(fault.time);
      expect(place.querySelector(".refused")!.textContent).toBe(fake.refuse);
    }
    expect(fake.resets.length).toBe(2);
  });

  it("is reset by nobody who only watches", () => {
    const place = faultSection(fake.app);
    fake.state({ operatorPage: kMe + 1, fault });
    expect(resetOf(place).disabled).toBe(true);
    expect(resetOf(place).title).toBe(words.resetViewer);
  });

  it("that is none takes the card away; the panel says so, as far as it is known", () => {
    const card = faultCard(fake.app);
    const panel = faultSection(fake.app);
    const said = () => panel.querySelector<HTMLElement>(".hint:not([hidden])")?.textContent;
    const body = panel.querySelector<HTMLElement>(".fault")!;
    expect(said()).toBe(strings.dash);
    fake.state({ operatorPage: kMe });
    expect([card.hidden, body.hidden, said()]).toEqual([true, true, words.none]);
    fake.state({ operatorPage: kMe, fault });
    expect([card.hidden, body.hidden]).toEqual([false, false]);
    fake.store.setPhase("waiting");
    expect([card.hidden, body.hidden, said()]).toEqual([true, true, strings.dash]);
  });
});
