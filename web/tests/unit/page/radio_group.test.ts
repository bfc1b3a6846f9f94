// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { radioGroup } from "../../../src/panels/radio_group";
import { lasting } from "../../../src/wire/memory";

const kKey = "test.radios";
const options = ["a", "b", "c"].map((value) => ({ value, name: `name of ${value}` }));
let picked: string[];
const made = () => {
  const group = radioGroup(kKey, "letters", "look", options, "b", (value) => picked.push(value));
  document.body.replaceChildren(group.element);
  return group;
};
const radios = () => [...document.querySelectorAll<HTMLElement>("[role=radio]")];
const attributes = (name: string) => radios().map((one) => one.getAttribute(name));
const press = (key: string) => {
  const event = new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true });
  (document.activeElement ?? document.body).dispatchEvent(event);
  return event.defaultPrevented;
};

describe("radios", () => {
  beforeEach(() => {
    lasting.set(kKey, "");
    picked = [];
  });

  it("are one stop of Tab, at the chosen one", () => {
    const group = made();
    expect(group.value).toBe("b");
    expect(attributes("aria-checked")).toEqual(["false", "true", "false"]);
    expect(attributes("tabindex")).toEqual(["-1", "0", "-1"]);
    radios()[2]!.click();
    expect(attributes("tabindex")).toEqual(["-1", "-1", "0"]);
    expect([group.value, picked]).toEqual(["c", ["c"]]);
  });

  it("are chosen by arrow keys, round and round, and no other key is taken", () => {
    made();
    radios()[1]!.focus();
    expect(press("ArrowRight")).toBe(true);
    expect(document.activeElement).toBe(radios()[2]);
    press("ArrowDown");
    expect(document.activeElement).toBe(radios()[0]);
    press("ArrowUp");
    press("ArrowLeft");
    expect(picked).toEqual(["c", "a", "c", "b"]);
    expect(press("Home")).toBe(false);
    expect(picked.length).toBe(4);
  });

  it("are remembered; what is not offered any more is not", () => {
    made();
    radios()[0]!.click();
    expect(made().value).toBe("a");
    lasting.set(kKey, "z");
    expect(made().value).toBe("b");
  });
});
