// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { listenToStopKeys } from "../../../src/panels/stop_keys";
import { lockPanel, signInForm } from "../../../src/people/sign_in";
import { stopBar, type StopBar } from "../../../src/people/stop_bar";
import { strings } from "../../../src/strings";
import { kStopAgainMs } from "../../../src/wire/stop_order";

let posts = 0;
let confirms = false;
let bar: StopBar;
const said = () => bar.element.querySelector(".stop-said:not([hidden])")?.textContent ?? "";

beforeEach(() => {
  vi.useFakeTimers();
  posts = 0;
  confirms = false;
  bar = stopBar(() => (++posts, Promise.resolve(confirms)));
  document.body.replaceChildren(bar.element);
});
afterEach(() => vi.useRealTimers());

describe("STOP on the page of patients", () => {
  it("is sent when the button goes down, and again until the station confirms it", async () => {
    bar.element.querySelector("button")!.dispatchEvent(new PointerEvent("pointerdown", { button: 0 }));
    expect(posts).toBe(1);
    await vi.advanceTimersByTimeAsync(2 * kStopAgainMs);
    expect(posts).toBe(3);
    expect(said()).toBe(strings.stop.failed);
    confirms = true;
    await vi.advanceTimersByTimeAsync(kStopAgainMs);
    expect(said()).not.toBe(strings.stop.failed);
    expect(said()).not.toBe("");
    const then = posts;
    await vi.advanceTimersByTimeAsync(10 * kStopAgainMs);
    expect(posts).toBe(then);
  });

  it("is Esc everywhere and Space outside of words, signed in, signed out and locked", () => {
    const source = document.createElement("div"); // in place of the window, which the files of tests share
    document.body.append(source);
    listenToStopKeys(source as unknown as Window, bar.stop);
    const press = (key: string, target: HTMLElement) => target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
    for (const gate of [signInForm(() => Promise.resolve()), lockPanel("a.meier", () => Promise.resolve(), () => {})]) {
      source.replaceChildren(gate);
      const password = gate.querySelector<HTMLInputElement>("input[type=password]")!;
      const before = posts;
      press("Escape", password);
      press(" ", gate.querySelector("button")!);
      expect(posts).toBe(before + 2);
      press(" ", password);
      expect(posts, "a password may hold blanks").toBe(before + 2);
    }
  });
});
