// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { create } from "@bufbuild/protobuf";
import { ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { faultCard } from "../../../src/panels/fault_card";
import { strings } from "../../../src/strings";
import { kProtocol } from "../../../src/wire/connection";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

const words = strings.fault;
const fault = { name: "sensor_jump", meaning: "A sensor's angle jumped.", remedy: "Check its cable.", channel: 7, time: 12.5, report: "out/faults/1.json" };
let fake: FakeApp;
let card: HTMLElement;
const reset = () => [...card.querySelectorAll("button")].find((one) => one.textContent === words.reset)!;
const report = () => card.querySelector("a")!;

beforeEach(() => {
  fake = fakeApp();
  card = faultCard(fake.app);
});

describe("a fault", () => {
  it("is told over the view, with what to do, and without the path of a file", () => {
    fake.state({ operatorPage: kMe, fault });
    expect(card.hidden).toBe(false);
    for (const text of [fault.meaning, fault.remedy, words.channel(7), "sensor jump"]) expect(card.textContent).toContain(text);
    expect(card.textContent).not.toContain("out/faults");
  });

  it("has a report that can be saved as soon as it is written, where the page may operate", () => {
    fake.state({ operatorPage: kMe, fault: { ...fault, report: "" } });
    expect(report().hidden).toBe(true);
    expect(card.textContent).toContain(words.reportPending);
    fake.state({ operatorPage: kMe, fault });
    expect(report().hidden).toBe(false);
    expect([report().getAttribute("href"), report().download]).toEqual(["report", words.reportFile("sensor_jump")]);
    const viewer = create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: false });
    fake.store.receive(create(ToPageSchema, { what: { case: "welcome", value: viewer } }));
    fake.state({ operatorPage: kMe + 1, fault });
    expect(report().hidden).toBe(true);
  });

  it("is reset, and what is refused is said", async () => {
    fake.state({ operatorPage: kMe, fault });
    fake.refuse = "the cause is still there";
    reset().click();
    await Promise.resolve().then(() => {});
    expect(fake.resets).toEqual([fault.time]);
    expect(card.querySelector(".refused")!.textContent).toBe(fake.refuse);
  });

  it("cannot be reset while the emergency stop is pressed, and says why", () => {
    const why = () => [...card.querySelectorAll<HTMLElement>(".warning")].some((one) => !one.hidden && one.textContent === words.pressed);
    fake.state({ operatorPage: kMe, fault, estop: true });
    expect([reset().disabled, why()]).toEqual([true, true]);
    fake.state({ operatorPage: kMe, fault, estop: false });
    expect([reset().disabled, why()]).toEqual([false, false]);
  });

  it("is not reset by a page that only watches", () => {
    fake.state({ operatorPage: kMe + 1, fault });
    expect([reset().disabled, reset().title]).toEqual([true, words.resetViewer]);
  });

  it("that is over takes the card away, and so does a lost connection", () => {
    fake.state({ operatorPage: kMe, fault });
    fake.state({ operatorPage: kMe });
    expect(card.hidden).toBe(true);
    fake.state({ operatorPage: kMe, fault });
    expect(card.hidden).toBe(false);
    fake.store.setPhase("waiting");
    expect(card.hidden).toBe(true);
  });
});
