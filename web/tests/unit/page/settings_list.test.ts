// SPDX-License-Identifier: Apache-2.0
// What the list of all settings says of each key.
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ChangeKind, KeyInfoSchema, KeyType } from "../../../src/gen/phalanx/cockpit_pb";
import { allowedText, factsText } from "../../../src/panels/settings_list";

describe("allowedText", () => {
  it("writes bounds, open and closed, and what may stand in a number's place", () => {
    const of = (type: KeyType, range: object) => allowedText(create(KeyInfoSchema, { type, range }));
    expect(of(KeyType.KEY_NUMBER, { min: 0, max: 15, minOpen: true })).toBe("range > 0, <= 15");
    expect(of(KeyType.KEY_NUMBER, { min: -1e6, max: 0, maxOpen: true, minusInfinity: true })).toBe("range >= -1000000, < 0, or -inf");
    expect(of(KeyType.KEY_NUMBER_OR_OFF, { min: 0, max: 10, minOpen: true })).toBe('range > 0, <= 10, or "off"');
    expect(of(KeyType.KEY_INTEGER, { min: 0, max: 9007199254740992 })).toBe("range >= 0, <= 9007199254740992");
  });

  it("lists choices, and names the type where any value is allowed", () => {
    expect(allowedText(create(KeyInfoSchema, { type: KeyType.KEY_CHOICE, choice: ["hooke", "duffing"] }))).toBe("range hooke, duffing");
    expect(allowedText(create(KeyInfoSchema, { type: KeyType.KEY_FLAG }))).toBe("range true, false");
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
