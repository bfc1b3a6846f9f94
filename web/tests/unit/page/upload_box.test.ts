// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { kUploadPatienceMs, reportLines, uploadBox } from "../../../src/panels/upload_box";
import { strings } from "../../../src/strings";
import type { ImportReport } from "../../../src/wire/http";
import { fakeApp, type FakeApp } from "./fake_app";

const words = strings.object;
const good: ImportReport = { ok: true, error: "", report: ["fine"], facts: null, findings: [], file: "/meshes/a.stl" };
interface Sent {
  readonly name: string;
  readonly size: number;
  readonly signal: AbortSignal;
  answer(report: ImportReport): void;
}
let fake: FakeApp;
let sent: Sent[] = [];
let box: HTMLElement;

beforeEach(() => {
  vi.useFakeTimers();
  fake = fakeApp();
  sent = [];
  const upload = (file: File, size: number, _unit: string, signal: AbortSignal) =>
    new Promise<ImportReport>((answer, fail) => {
      signal.addEventListener("abort", () => fail(new Error("AbortError")));
      sent.push({ name: file.name, size, signal, answer });
    });
  box = uploadBox({ ...fake.app, upload }).element;
  document.body.replaceChildren(box);
});
afterEach(() => vi.useRealTimers());

const named = (text: string) => [...box.querySelectorAll("button")].find((one) => one.textContent === text)!;
const size = () => box.querySelector<HTMLInputElement>("input.number")!;
const verdict = () => (box.querySelector<HTMLElement>(".import")!.hidden ? "" : box.querySelector(".import-verdict")!.textContent);
const flush = () => vi.advanceTimersByTimeAsync(0);
function choose(name: string): void {
  const picker = box.querySelector<HTMLInputElement>("input[type=file]")!;
  Object.defineProperty(picker, "files", { configurable: true, value: [new File(["solid"], name)] });
  picker.dispatchEvent(new Event("change"));
}
function type(millimetres: string): void {
  size().value = millimetres;
  size().dispatchEvent(new Event("input"));
}

describe("a mesh of one's own", () => {
  it("is used at the size of which the report speaks: another size takes the report back", async () => {
    choose("a.stl");
    named(words.upload).click();
    sent[0]!.answer(good);
    await flush();
    expect(verdict()).toBe(words.good);
    type("300");
    expect(verdict()).toBe("");
    named(words.upload).click();
    expect(sent[1]!.size).toBe(300);
    sent[1]!.answer(good);
    await flush();
    named(words.useMesh).click();
    await flush();
    expect(fake.asked.flat().map(([, value]) => value).join()).toContain("size_mm = 300");
  });

  it("that is no longer the chosen one is given up, and its answer is not the new one's", async () => {
    choose("a.stl");
    named(words.upload).click();
    expect(named(words.upload).disabled).toBe(true);
    choose("b.stl");
    expect(sent[0]!.signal.aborted).toBe(true);
    expect(named(words.upload).disabled).toBe(false);
    sent[0]!.answer(good);
    await flush();
    expect(verdict()).toBe("");
    expect(box.textContent).toContain("b.stl");
    named(words.upload).click();
    sent[1]!.answer({ ...good, ok: false });
    await flush();
    expect(verdict()).toBe(words.bad);
  });

  it("does not wait for ever: neither on a line that says nothing nor on one that is known to be lost", async () => {
    for (const end of [() => vi.advanceTimersByTimeAsync(kUploadPatienceMs), () => Promise.resolve(fake.store.setPhase("waiting"))]) {
      choose("a.stl");
      named(words.upload).click();
      await end();
      await flush();
      expect(sent.at(-1)!.signal.aborted).toBe(true);
      expect(box.querySelector(".refused:not([hidden])")?.textContent).toBe(words.noConnection);
      expect(named(words.upload).disabled).toBe(false);
      expect(box.textContent).toContain("a.stl");
    }
  });
});

it("an import's report is lines for people", () => {
  const facts = { verdict: "usable: a closed solid", triangles: 2404, vertices: 1204, extent: [0.061, 0.04, 0.038], closed: true, volume: 5e-5 };
  expect(reportLines({ ...good, facts })).toEqual(["usable: a closed solid", "1,204 vertices, 2,404 triangles", "61.0 × 40.0 × 38.0 mm", "closed, 50.0 cm³"]);
  expect(reportLines(good)).toEqual(["fine"]);
});
