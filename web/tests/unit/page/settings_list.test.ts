// SPDX-License-Identifier: Apache-2.0
// What the list of all settings says of each key.
import { create } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { ChangeKind, KeyInfoSchema, KeyType, ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { allowedText, factsText, settingsList, type SettingsList } from "../../../src/panels/settings_list";
import { strings } from "../../../src/strings";
import { kProtocol } from "../../../src/wire/connection";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

describe("allowedText", () => {
  it("writes bounds, open and closed, and what may stand in a number's place", () => {
    const of = (type: KeyType, range: object) => allowedText(create(KeyInfoSchema, { type, range }));
    expect(of(KeyType.KEY_NUMBER, { min: 0, max: 15, minOpen: true })).toBe("range > 0, <= 15");
    expect(of(KeyType.KEY_NUMBER, { min: -1e6, max: 0, maxOpen: true, minusInfinity: true })).toBe("range >= -1000000, < 0, or -inf");
    expect(of(KeyType.KEY_NUMBER_OR_OFF, { min: 0, max: 10, minOpen: true })).toBe('range > 0, <= 10, or "off"');
    expect(of(KeyType.KEY_INTEGER, { min: 0, max: 9007199254740992 })).toBe("range >= 0, <= 9007199254740992");
  });

  it("lists choices, and names the type where any value is allowed", () => {
    const { laws } = strings.force;
    const law = create(KeyInfoSchema, { path: "force.law", type: KeyType.KEY_CHOICE, choice: ["hooke", "duffing"], defaultValue: '"hooke"' });
    expect(allowedText(law)).toBe(strings.settings.oneOf(`${laws["hooke"]}, ${laws["duffing"]}`));
    expect(factsText(law, "")).toContain(strings.settings.default(laws["hooke"]!));
    expect(allowedText(create(KeyInfoSchema, { type: KeyType.KEY_FLAG }))).toBe(strings.settings.oneOf("on, off"));
    expect(allowedText(create(KeyInfoSchema, { type: KeyType.KEY_FILE }))).toBe("file");
    const unbounded = { min: -Infinity, max: Infinity };
    expect(allowedText(create(KeyInfoSchema, { type: KeyType.KEY_VECTOR, range: unbounded }))).toBe("vector");
  });
});

describe("factsText", () => {
  const length = create(KeyInfoSchema, {
    type: KeyType.KEY_NUMBER,
    range: { min: 0, max: 1000, minOpen: true },
    defaultValue: "50",
    change: ChangeKind.CHANGE_NEW_STATION,
    kind: [{ kind: "pen", defaultValue: "140" }],
  });

  it("has the default of the kind of object, else the key's own", () => {
    const facts = (value: string) => `range > 0, <= 1000 · default ${value} · the station ends and another one begins`;
    expect(factsText(length, "pen")).toBe(facts("140"));
    expect(factsText(length, "sphere")).toBe(facts("50"));
  });

  it("names each requirement of a change", () => {
    const facts = (change: ChangeKind) => factsText(create(KeyInfoSchema, { type: KeyType.KEY_TEXT, change }), "");
    expect(facts(ChangeKind.CHANGE_AT_ZERO_TORQUE)).toBe("text · the torque goes to zero and returns");
    expect(facts(ChangeKind.CHANGE_OTHER_OBJECT)).toMatch(/^text · another object: /);
  });

  it("leaves out a default that is no text", () => {
    const key = create(KeyInfoSchema, { type: KeyType.KEY_TEXT, defaultValue: '""', change: ChangeKind.CHANGE_IN_CONTACT });
    expect(factsText(key, "")).toBe("text · changes at once, within 0.2 s");
  });
});

describe("the list of all settings", () => {
  const keys = [
    { path: "rate_hz", meaning: "ticks per second", type: KeyType.KEY_NUMBER, defaultValue: "200" },
    { path: "force.law", meaning: "force over depth", type: KeyType.KEY_CHOICE, choice: ["hooke", "duffing"], defaultValue: '"hooke"' },
    { path: "force.exponent", meaning: "exponent n of the depth", type: KeyType.KEY_NUMBER, defaultValue: "1.5" },
    { path: "limits.joint_torque_nm", meaning: "largest torque of a joint", type: KeyType.KEY_NUMBER_OR_OFF, defaultValue: "0.3" },
  ];
  let fake: FakeApp;
  let list: SettingsList;
  let searching: boolean;

  beforeEach(() => {
    fake = fakeApp();
    const welcome = create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: true, key: keys });
    list = settingsList(fake.app, (now) => (searching = now));
    fake.store.receive(create(ToPageSchema, { what: { case: "welcome", value: welcome } }));
    fake.operate(kMe);
  });
  const shown = () =>
    [...list.element.querySelectorAll<HTMLDetailsElement>("details")]
      .filter((group) => !group.hidden)
      .map((group) => [group.querySelector("summary")!.textContent, group.open, [...group.querySelectorAll<HTMLElement>("li")].filter((one) => !one.hidden).map((one) => one.querySelector("strong")!.textContent)]);
  const search = (text: string) => {
    const field = list.head.querySelector<HTMLInputElement>("input[type=search]")!;
    field.value = text;
    field.dispatchEvent(new Event("input"));
  };
  const words = strings.settings;

  it("groups the keys under headings that open, with labels first", () => {
    expect(shown()).toEqual([
      [words.groups["general"], false, ["Update rate"]],
      [words.groups["force"], false, ["Force law", "Exponent"]],
      [words.groups["limits"], false, ["Torque of a joint, at most"]],
    ]);
    expect(searching).toBe(false);
  });

  it("finds by label, key and meaning, every word of them", () => {
    search("depth expo");
    expect(shown()).toEqual([[words.groups["force"], true, ["Exponent"]]]);
    expect(searching).toBe(true);
    search("joint_torque");
    expect(shown()).toEqual([[words.groups["limits"], true, ["Torque of a joint, at most"]]]);
    search("TICKS");
    expect(shown().map(([name]) => name)).toEqual([words.groups["general"]]);
    search("");
    expect(shown().map(([, open]) => open)).toEqual([false, false, false]);
    expect(searching).toBe(false);
  });

  it("keeps what was typed until it is granted, and asks for one thing at a time", async () => {
    const exponent = [...list.element.querySelectorAll<HTMLElement>("li")].find((one) => one.querySelector("strong")!.textContent === words.labels["force.exponent"])!;
    const input = exponent.querySelector("input")!;
    const set = [...exponent.querySelectorAll("button")].find((one) => one.textContent === words.apply)!;
    const error = exponent.querySelector<HTMLElement>("[role=alert]")!;
    input.value = "900";
    input.dispatchEvent(new Event("input"));
    fake.refuse = "too large";
    set.click();
    fake.operate(kMe);
    expect([set.disabled, input.value]).toEqual([true, "900"]);
    await vi.waitFor(() => expect(error.textContent).toBe("too large"));
    fake.operate(kMe);
    expect([set.disabled, input.value, error.hidden]).toEqual([false, "900", false]);
    fake.refuse = "";
    set.click();
    await vi.waitFor(() => expect(error.hidden).toBe(true));
    expect(set.disabled).toBe(true);
    expect(fake.asked.length).toBe(2);
  });

  it("filters by group, and what differs from the scene", () => {
    const [box] = list.head.querySelectorAll<HTMLButtonElement>("[role=combobox]");
    document.body.replaceChildren(list.head);
    box!.click();
    list.head.querySelector<HTMLElement>("[data-value=limits]")!.click();
    expect(shown().map(([name]) => name)).toEqual([words.groups["limits"]]);
    box!.click();
    list.head.querySelector<HTMLElement>('[data-value=""]')!.click();
    fake.state({ operatorPage: kMe, changed: [{ key: "force.law", value: '"duffing"' }], value: [{ key: "force.law", value: '"duffing"' }] });
    list.head.querySelector<HTMLElement>("[role=switch]")!.click();
    expect(shown()).toEqual([[words.groups["force"], true, ["Force law"]]]);
  });
});
