// SPDX-License-Identifier: Apache-2.0
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { afterEach, expect, it, vi } from "vitest";
import { kLanguageKey, languages, strings } from "../../../src/strings";

const html = (name: string) => readFileSync(resolve(__dirname, `../../../${name}`), "utf8");
const page = html("index.html");
const brought = vi.fn();
const withoutScripts = (page: string) => /<noscript>(.*)<\/noscript>/.exec(page)![1]!.replace(/<[^>]*>/g, "");
afterEach(() => {
  localStorage.clear();
  vi.resetModules(); // the next module that reads the language finds no choice
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

/// Takes the first script in, with frames that are painted when the test says so.
async function open(): Promise<() => void> {
  const frames: (() => void)[] = [];
  vi.useFakeTimers();
  vi.stubGlobal("requestAnimationFrame", (call: () => void) => frames.push(call));
  brought.mockClear();
  vi.resetModules();
  vi.doMock("../../../src/main", () => {
    brought();
    return {};
  });
  await import("../../../src/opening");
  return () => frames.forEach((call) => call());
}

it("the page's frame stands in index.html itself, in English, and without scripts in every language, with no style or script that the station forbids", () => {
  const parsed = new DOMParser().parseFromString(page.replace(/<(script|link)[^>]*>/g, ""), "text/html"); // which would be fetched
  expect(parsed.documentElement.lang).toBe(strings.locale);
  expect(parsed.title).toBe(strings.title);
  expect(parsed.querySelector("#page > #opening h1")!.textContent).toBe(strings.product);
  expect(parsed.querySelector("#page > #opening p")!.textContent).toBe(strings.opening);
  expect(withoutScripts(page)).toBe(languages.map(({ texts }) => texts.noScript).join(" "));
  expect(page).not.toMatch(/<style|style=|<script(?![^>]* src=)/);
});

it("so does the frame of the page of recordings, which looks like a recording from its first moment", () => {
  const recording = html("recording.html");
  const parsed = new DOMParser().parseFromString(recording.replace(/<(script|link)[^>]*>/g, ""), "text/html");
  expect(parsed.documentElement.lang).toBe(strings.locale);
  expect(parsed.documentElement.dataset["page"]).toBe("recording");
  expect(parsed.title).toBe(strings.replay.titleNone);
  expect(parsed.querySelector("#page > #opening.band p")!.textContent).toBe(strings.opening);
  expect(withoutScripts(recording)).toBe(languages.map(({ texts }) => texts.replay.noScript).join(" "));
  expect(recording).not.toMatch(/<style|style=|<script(?![^>]* src=)/);
  expect(recording).not.toContain("icon.svg"); // the cockpit's
});

it("the page itself comes after the first frame, not before", async () => {
  const paint = await open();
  await vi.advanceTimersByTimeAsync(1);
  expect(brought).not.toHaveBeenCalled();
  paint();
  await vi.advanceTimersByTimeAsync(1);
  vi.useRealTimers(); // what follows is not for want of a frame
  await vi.waitFor(() => expect(brought).toHaveBeenCalledOnce());
  expect(document.documentElement.lang).toBe(strings.locale);
});

it("a page that nobody sees comes, too", async () => {
  await open();
  await vi.advanceTimersByTimeAsync(1000);
  vi.useRealTimers();
  await vi.waitFor(() => expect(brought).toHaveBeenCalledOnce());
});

it.each(languages)("the first script says that the page opens in the language that this browser remembers, $code", async ({ code, texts }) => {
  localStorage.setItem(kLanguageKey, code);
  document.body.innerHTML = '<header id="opening"><h1>Phalanx</h1><p>…</p></header>';
  await open();
  expect(document.documentElement.lang).toBe(texts.locale);
  expect(document.querySelector("#opening p")!.textContent).toBe(texts.opening);
});
