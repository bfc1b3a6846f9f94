// SPDX-License-Identifier: Apache-2.0
// A browser that cannot draw: happy-dom has no WebGL.
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { MeshPreviewBox } from "../../../src/panels/mesh_preview_box";
import { strings } from "../../../src/strings";
import { refusedReport, type ImportReport } from "../../../src/wire/import_report";

const words = strings.object;
const mesh = { position: Float32Array.from([0, 0, 0, 0.06, 0, 0, 0, 0.06, 0]), index: Uint32Array.from([0, 1, 2]) };
const facts = { verdict: "usable", triangles: 1, vertices: 3, extent: [0.06, 0.06, 0], closed: false, sheets: 1, volume: 0 };
const good: ImportReport = { ...refusedReport(""), ok: true, facts, file: "/meshes/a.stl", preview: mesh };
const patience = { timeout: 600_000 }; // against hangs only: the module is compiled meanwhile
let box: MeshPreviewBox;
const note = () => box.element.querySelector<HTMLElement>(".mesh-preview-note")!;
const host = () => box.element.querySelector<HTMLElement>(".mesh-preview-host")!;

beforeEach(() => {
  vi.spyOn(console, "error").mockImplementation(() => {}); // three.js complains there as well
  box = new MeshPreviewBox();
});
afterEach(() => vi.restoreAllMocks());

it("says in place of a picture why there is none", async () => {
  box.setOpen(true);
  expect(note().textContent).toBe(words.previewEmpty);
  box.show({ ...good, preview: null });
  expect(note().textContent).toBe(words.previewMissing);
  box.show(refusedReport("a.stl: is no mesh"));
  expect(note().textContent).toBe(words.previewEmpty);
  box.show(good);
  expect(note().textContent).toBe(words.previewLoading);
  await vi.waitUntil(() => note().textContent === words.previewFailed, patience);
  expect([note().hidden, host().hidden]).toEqual([false, true]);
});

it("has something to draw with only while it is open", async () => {
  box.show(good);
  await new Promise((done) => setTimeout(done));
  expect(box.probe()).toBeUndefined();
  box.setOpen(true);
  await vi.waitUntil(() => box.probe() !== undefined, patience);
  expect(host().childElementCount).toBe(1);
  box.setUp("y");
  expect(box.probe()!.up).toBe("y");
  box.setOpen(false);
  expect(box.probe()).toBeUndefined();
  expect(host().childElementCount).toBe(0);
  box.setOpen(true);
  box.setOpen(false); // before the module has come
  await import("../../../src/view3d/mesh_preview");
  await new Promise((done) => setTimeout(done));
  expect(box.probe()).toBeUndefined();
});

it("says how many triangles are drawn if they are not all", () => {
  const hint = () => box.element.querySelector<HTMLElement>(".hint")!;
  box.show(good);
  expect(hint().hidden).toBe(true);
  box.show({ ...good, facts: { ...facts, triangles: 12034 } });
  expect(hint().hidden).toBe(false);
  expect(hint().textContent).toBe(words.previewSimplified("1", "12,034"));
  box.show(null);
  expect(hint().hidden).toBe(true);
});
