// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { kUploadPatienceMs, uploadBox, type UploadBox } from "../../../src/panels/upload_box";
import { vector } from "../../../src/state/toml";
import { strings } from "../../../src/strings";
import { refusedReport, type ImportReport } from "../../../src/wire/import_report";
import { fakeApp, kMe, type FakeApp } from "./fake_app";

const words = strings.object;
const mesh = { position: Float32Array.from([0, 0, 0, 0.06, 0, 0, 0, 0.06, 0]), index: Uint32Array.from([0, 1, 2]) };
const good: ImportReport = { ...refusedReport(""), ok: true, report: ["fine"], file: "/meshes/a.stl", preview: mesh };
interface Sent {
  readonly name: string;
  readonly size: number;
  readonly signal: AbortSignal;
  answer(report: ImportReport): void;
}
let fake: FakeApp;
let sent: Sent[] = [];
let upload: UploadBox;
let box: HTMLElement;

beforeEach(() => {
  vi.useFakeTimers();
  fake = fakeApp();
  sent = [];
  const send = (file: File, size: number, _unit: string, signal: AbortSignal) =>
    new Promise<ImportReport>((answer, fail) => {
      signal.addEventListener("abort", () => fail(new Error("AbortError")));
      sent.push({ name: file.name, size, signal, answer });
    });
  upload = uploadBox({ ...fake.app, upload: send });
  box = upload.element;
  document.body.replaceChildren(box);
});
afterEach(() => vi.useRealTimers());

const named = (text: string) => [...box.querySelectorAll("button")].find((one) => one.textContent === text)!;
const size = () => box.querySelector<HTMLInputElement>("input.number")!;
const summary = () => (box.querySelector<HTMLElement>(".import")!.hidden ? "" : box.querySelector(".import-summary")!.textContent);
const pressed = () => [...box.querySelectorAll(".up-axis button[aria-pressed=true]")].map((one) => one.textContent);
const note = () => box.querySelector(".mesh-preview-note")!.textContent;
/// The value of a key in the last change.
const asked = (key: string) => new RegExp(`${key} = (\\[[^\\]]*\\]|[^,}]*)`).exec(fake.asked.at(-1)!.map(([, value]) => value).join())?.[1];
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
    expect(summary()).toBe(words.usable("a.stl"));
    type("300");
    expect(summary()).toBe("");
    named(words.upload).click();
    expect(sent[1]!.size).toBe(300);
    sent[1]!.answer(good);
    await flush();
    named(words.useMesh).click();
    await flush();
    expect(asked("size_mm")).toBe("300");
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
    expect(summary()).toBe("");
    expect(box.textContent).toContain("b.stl");
    named(words.upload).click();
    sent[1]!.answer(refusedReport("b.stl: is no mesh; export it again"));
    await flush();
    expect(summary()).toBe("b.stl: is no mesh; export it again");
  });

  it("does not wait for ever: neither on a line that says nothing nor on one that is known to be lost", async () => {
    for (const end of [() => vi.advanceTimersByTimeAsync(kUploadPatienceMs), () => Promise.resolve(fake.store.setPhase("waiting"))]) {
      choose("a.stl");
      named(words.upload).click();
      await end();
      await flush();
      expect(sent.at(-1)!.signal.aborted).toBe(true);
      expect(summary()).toBe(words.refused("a.stl", words.noConnection));
      expect(named(words.upload).disabled).toBe(false);
      expect(box.textContent).toContain("a.stl");
    }
  });

  it("stands in the scene as its upward axis says, whatever the attitude of the object before", async () => {
    fake.operate(kMe, [["objects.0.rotation_deg", "[10, 20, 30]"], ["objects.0.position_mm", "[1, 2, 3]"]]);
    for (const [axis, rotation] of [["x", [0, -90, 0]], ["y", [90, 0, 0]], ["z", [0, 0, 0]]] as const) {
      choose("a.stl");
      expect(pressed()).toEqual(["z"]);
      named(words.upload).click();
      sent.at(-1)!.answer(good);
      await flush();
      named(axis).click();
      expect(pressed()).toEqual([axis]);
      expect(summary(), "the report stays").not.toBe("");
      named(words.useMesh).click();
      await flush();
      expect(vector(asked("rotation_deg")!)).toEqual(rotation);
      expect(fake.asked.at(-1)!.map(([, value]) => value).join().match(/rotation_deg/g)).toHaveLength(1);
      expect(vector(asked("position_mm")!)).toEqual([1, 2, 3]);
    }
  });

  it("has y up in a .glb, until another file is chosen", () => {
    choose("a.glb");
    expect(pressed()).toEqual(["y"]);
    named("x").click();
    type("80");
    expect(pressed(), "another size is the same file").toEqual(["x"]);
    choose("b.stl");
    expect(pressed()).toEqual(["z"]);
    upload.take(new File(["glTF"], "c.GLB"));
    expect(pressed()).toEqual(["y"]);
  });

  it("can be used though the station sent no picture of it", async () => {
    choose("a.stl");
    expect(note()).toBe(words.previewEmpty);
    named(words.upload).click();
    sent[0]!.answer({ ...good, preview: null });
    await flush();
    expect(note()).toBe(words.previewMissing);
    expect(named(words.useMesh).hidden).toBe(false);
  });

  it("is uploaded while its dialog is closed, and its report is there when that opens again", async () => {
    upload.setOpen(true);
    choose("a.stl");
    named(words.upload).click();
    upload.setOpen(false);
    expect(sent[0]!.signal.aborted).toBe(false);
    sent[0]!.answer(good);
    await flush();
    expect(summary()).toBe(words.usable("a.stl"));
    expect(upload.probe()).toBeUndefined();
  });

  it("is replaced by a file that is dropped while it is uploaded", async () => {
    choose("a.stl");
    named(words.upload).click();
    upload.take(new File(["solid"], "b.stl"));
    expect(sent.map(({ name, signal }) => [name, signal.aborted])).toEqual([["a.stl", true], ["b.stl", false]]);
    sent[1]!.answer(refusedReport("another mesh is being read; try again when it is done"));
    await flush();
    expect(summary()).toBe(words.refused("b.stl", "another mesh is being read; try again when it is done"));
    expect(named(words.upload).disabled, "so it is tried again").toBe(false);
  });

  it("hides its details until they are asked for", async () => {
    choose("a.stl");
    named(words.upload).click();
    sent[0]!.answer({ ...good, findings: ["12 duplicate vertices: merged"] });
    await flush();
    const details = box.querySelector<HTMLDetailsElement>(".import details")!;
    expect([details.hidden, details.open]).toEqual([false, false]);
    expect(details.textContent).toContain("12 duplicate vertices: merged");
    expect(details.textContent).toContain("fine");
  });
});
