// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { ChoiceBox } from "../../../src/panels/choice_box";
import { listenInThisFile } from "./window_keys";

const picked = vi.fn();
const stop = vi.fn();
let box: ChoiceBox;
listenInThisFile({ stop, pause: () => {}, help: () => {}, camera: () => {}, zoom: () => {} });

beforeEach(() => {
  vi.clearAllMocks();
  box = new ChoiceBox(picked);
  box.name("Law");
  box.setChoices(["a", "b", "c"].map((value) => ({ value, text: value.toUpperCase() })));
  box.value = "b";
  const fieldset = document.createElement("fieldset");
  fieldset.append(box.button, box.list);
  document.body.replaceChildren(fieldset);
  box.button.focus();
});

const key = (name: string) => box.button.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
const active = () => document.getElementById(box.button.getAttribute("aria-activedescendant") ?? "")?.textContent;

describe("a choice", () => {
  it("says what is chosen, and that there are others", () => {
    expect(box.button.textContent).toBe("B");
    expect(box.button.getAttribute("role")).toBe("combobox");
    expect(box.button.getAttribute("aria-expanded")).toBe("false");
    expect(box.list.querySelector("[aria-selected=true]")?.textContent).toBe("B");
  });

  it("is made by keys alone", () => {
    key("Enter");
    expect(box.open).toBe(true);
    expect(active()).toBe("B");
    key("ArrowUp");
    key("ArrowUp");
    expect(active()).toBe("A");
    key("End");
    expect(active()).toBe("C");
    key("Home");
    key("ArrowDown");
    key("ArrowDown");
    key("Enter");
    expect(box.open).toBe(false);
    expect(box.value).toBe("c");
    expect(picked).toHaveBeenCalledTimes(1);
  });

  it("never takes Space or Esc for itself: they stop, with the list open, too", () => {
    for (const [i, name] of [" ", "Escape"].entries()) {
      box.button.click();
      expect(box.open).toBe(true);
      key("ArrowDown");
      key(name);
      expect(stop).toHaveBeenCalledTimes(i + 1);
      box.close();
    }
    expect(box.value).toBe("b");
    expect(picked).not.toHaveBeenCalled();
  });

  it("is made by a press on an option, and the same one again is no change", () => {
    box.button.click();
    box.list.querySelector<HTMLElement>("[data-value=b]")!.click();
    expect(picked).not.toHaveBeenCalled();
    box.button.click();
    box.list.querySelector<HTMLElement>("[data-value=a]")!.click();
    expect(picked).toHaveBeenCalledTimes(1);
    expect(box.value).toBe("a");
  });

  it("ends when the focus goes, and where this page has no control nothing opens or is chosen", () => {
    box.button.click();
    box.button.dispatchEvent(new FocusEvent("blur"));
    expect(box.open).toBe(false);
    box.button.click();
    document.querySelector("fieldset")!.setAttribute("disabled", "");
    box.list.querySelector<HTMLElement>("[data-value=a]")!.click();
    expect(box.value).toBe("b");
    key("Enter");
    expect(box.open).toBe(false);
    expect(picked).not.toHaveBeenCalled();
  });
});
