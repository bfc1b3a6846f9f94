// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it } from "vitest";
import { ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { handSection } from "../../../src/panels/hand_section";
import { strings } from "../../../src/strings";
import { kProtocol } from "../../../src/wire/connection";
import type { Change } from "../../../src/wire/host";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

let fake: FakeApp;
let panel: HTMLElement;
const words = strings.hand;

beforeEach(() => {
  fake = fakeApp();
  const profile = [{ name: "large-man", meaning: "a large man's left hand" }];
  const welcome = create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: true, key: fake.store.welcome!.key, profile });
  fake.store.receive(create(ToPageSchema, { what: { case: "welcome", value: welcome } }));
  panel = handSection(fake.app);
  document.body.replaceChildren(panel);
});

/// What is stated, by the scene or, where it is changed, by somebody.
function state(values: Readonly<Record<string, string>>, changed: readonly string[] = []): void {
  const of = (names: readonly string[]) => names.map((key) => ({ key, value: values[key] ?? "" }));
  fake.state({ operatorPage: kMe, value: of(Object.keys(values)), changed: of(changed) });
}
const box = (name: string) => panel.querySelector<HTMLButtonElement>(`[role=combobox][aria-label="${name}"]`)!;
async function choose(name: string, value: string): Promise<readonly Change[]> {
  box(name).click();
  document.getElementById(box(name).getAttribute("aria-controls")!)!.querySelector<HTMLElement>(`[data-value="${value}"]`)!.click();
  await Promise.resolve();
  return fake.asked.at(-1)!;
}

describe("the side of the hand", () => {
  it("is that of the hand which is drawn: a right one, mirrored or not, or a stated left one", () => {
    for (const [values, said] of [
      [{}, words.right],
      [{ mirror: "true" }, words.left],
      [{ "hand.side": '"left"' }, words.left],
      [{ "hand.side": '"left"', mirror: "true" }, words.right],
    ] as const) {
      state(values);
      expect(box(words.side).textContent, JSON.stringify(values)).toBe(said);
    }
  });

  it("is changed by a mirror, which turns the objects, too", async () => {
    state({});
    expect(await choose(words.side, "left")).toEqual([["mirror", "true"]]);
    state({ mirror: "true" }, ["mirror"]);
    expect(await choose(words.side, "right")).toEqual([["mirror", "false"]]);
  });

  it("of a scene laid out for a left hand is right in a mirror", async () => {
    state({ "hand.side": '"left"' });
    expect(await choose(words.side, "right")).toEqual([["mirror", "true"]]);
  });

  it("takes back what somebody stated of the hand alone", async () => {
    state({ "hand.side": '"left"' }, ["hand.side"]);
    expect(await choose(words.side, "right")).toEqual([["hand.side", ""], ["mirror", "false"]]);
  });

  it("is the profile's where there is one, which is chosen whatever was said of the side before", async () => {
    const row = () => box(words.side).closest<HTMLElement>(".row")!.hidden;
    state({ mirror: "true" }, ["mirror"]);
    expect(row()).toBe(false);
    expect(await choose(words.profile, "large-man")).toEqual([["mirror", ""], ["hand.profile", '"large-man"']]);
    state({ "hand.profile": '"large-man"' }, ["hand.profile"]);
    expect(row()).toBe(true);
    expect(await choose(words.profile, "")).toEqual([["hand.profile", ""]]);
  });
});
