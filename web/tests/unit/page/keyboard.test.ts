// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { listenInThisFile } from "./window_keys";

const actions = { stop: vi.fn(), pause: vi.fn(), help: vi.fn(), camera: vi.fn(), zoom: vi.fn() };

/// @returns whether the browser's own answer to the key was held back
function press(target: EventTarget, key: string, more: KeyboardEventInit = {}, type = "keydown"): boolean {
  return !target.dispatchEvent(new KeyboardEvent(type, { key, bubbles: true, cancelable: true, ...more }));
}
function add<K extends keyof HTMLElementTagNameMap>(tag: K, type = ""): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  if (element instanceof HTMLInputElement) element.type = type;
  document.body.append(element);
  return element;
}

listenInThisFile(actions);
beforeEach(() => {
  vi.clearAllMocks();
  document.body.replaceChildren();
});

describe("keys", () => {
  it("Space stops wherever it is no letter, and never presses what has the focus", () => {
    const places = [document.body, add("button"), add("select"), add("input", "range"), add("input", "checkbox"), add("a")];
    for (const place of places) {
      expect(press(place, " "), place.tagName).toBe(true);
      expect(press(place, " ", {}, "keyup"), place.tagName).toBe(true);
    }
    expect(actions.stop).toHaveBeenCalledTimes(places.length);
  });

  it("Space is a letter in text fields", () => {
    for (const place of [add("input", "text"), add("input", "search"), add("textarea")]) {
      expect(press(place, " ")).toBe(false);
      expect(press(place, " ", {}, "keyup")).toBe(false);
    }
    expect(actions.stop).not.toHaveBeenCalled();
  });

  it("Space stops also from a field for a number, where figures act as figures", () => {
    const number = add("input", "text");
    number.setAttribute("inputmode", "decimal");
    for (const field of [number, add("input", "number")]) {
      expect(press(field, " ")).toBe(true);
      expect(press(field, "3")).toBe(false);
    }
    expect(actions.stop).toHaveBeenCalledTimes(2);
    expect(actions.camera).not.toHaveBeenCalled();
  });

  it("Esc stops everywhere, also in text fields, and with any other key held", () => {
    press(document.body, "Escape");
    press(add("input", "text"), "Escape");
    press(add("textarea"), "Escape", { shiftKey: true, ctrlKey: true });
    expect(actions.stop).toHaveBeenCalledTimes(3);
  });

  it("Esc stops also while a text is being composed, where the key has no name", () => {
    press(add("input", "text"), "Process", { code: "Escape", isComposing: true });
    press(add("input", "text"), "Process", { code: "KeyA", isComposing: true });
    expect(actions.stop).toHaveBeenCalledOnce();
  });

  it("a key that is held down stops again, five times a second at most", () => {
    vi.useFakeTimers();
    vi.advanceTimersByTime(1000);
    press(document.body, " ");
    for (let i = 1; i <= 30; ++i) {
      vi.advanceTimersByTime(1000 / 30);
      expect(press(document.body, i % 2 ? " " : "Escape", { repeat: true })).toBe(i % 2 === 1);
    }
    vi.useRealTimers();
    const times = actions.stop.mock.calls.length;
    expect(times).toBeGreaterThan(3);
    expect(times).toBeLessThanOrEqual(6); // the press, and five more
  });

  it("nobody behind it can take Stop away", () => {
    const button = add("button");
    const seen = vi.fn((event: Event) => event.stopPropagation());
    button.addEventListener("keydown", seen);
    press(button, " ");
    expect(actions.stop).toHaveBeenCalledOnce();
    expect(seen).not.toHaveBeenCalled();
  });

  it("letters and figures act outside text fields only, and not with Ctrl", () => {
    press(document.body, "p");
    press(document.body, "3");
    press(document.body, "+");
    press(document.body, "?");
    expect(actions.pause).toHaveBeenCalledOnce();
    expect(actions.camera).toHaveBeenCalledWith("thumb");
    expect(actions.zoom.mock.calls[0]?.[0]).toBeGreaterThan(1);
    expect(actions.help).toHaveBeenCalledOnce();
    const field = add("input", "text");
    for (const key of ["p", "3", "+", "?"]) expect(press(field, key)).toBe(false);
    press(document.body, "p", { ctrlKey: true });
    expect(actions.pause).toHaveBeenCalledOnce();
    expect(actions.camera).toHaveBeenCalledOnce();
  });
});
