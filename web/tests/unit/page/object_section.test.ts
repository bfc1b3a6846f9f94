// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it, vi } from "vitest";
import { KeyType, ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { objectSection } from "../../../src/panels/object_section";
import { kProtocol } from "../../../src/wire/connection";
import { fakeApp, kMe } from "./fake_app";

const key = [
  { path: "objects[].kind", type: KeyType.KEY_CHOICE, choice: ["sphere", "pen"], defaultValue: '"sphere"' },
  { path: "objects[].diameter_mm", type: KeyType.KEY_NUMBER, defaultValue: "60", kind: [{ kind: "sphere", defaultValue: "60" }] },
];

it("an object that is refused keeps the sizes that were typed; while one is asked for, no other is", async () => {
  const fake = fakeApp();
  fake.store.receive(create(ToPageSchema, { what: { case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: true, key }) } }));
  fake.operate(kMe);
  const section = objectSection(fake.app, () => {});
  const use = section.querySelector<HTMLButtonElement>("button.primary")!;
  const error = section.querySelector<HTMLElement>("[role=alert]")!;
  const field = () => section.querySelector("input")!;
  expect([field().value, use.disabled]).toEqual(["60", true]);
  field().value = "500";
  field().dispatchEvent(new Event("input"));
  expect(use.disabled).toBe(false);
  fake.refuse = "no finger meets it";
  use.click();
  fake.operate(kMe);
  expect(use.disabled).toBe(true);
  await vi.waitFor(() => expect(error.textContent).toBe("no finger meets it"));
  fake.operate(kMe);
  expect([field().value, use.disabled, error.hidden]).toEqual(["500", false, false]);
  fake.refuse = "";
  use.click();
  await vi.waitFor(() => expect(field().value).toBe("60")); // what is in force
  expect([fake.asked.length, error.hidden, use.disabled]).toEqual([2, true, true]);
});
