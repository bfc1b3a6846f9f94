// SPDX-License-Identifier: Apache-2.0
import { beforeAll, expect, it } from "vitest";
import { savedPicture } from "../../../src/view3d/saved_picture";
import { drawnOn, fakeCanvases } from "../page/fake_canvas";

beforeAll(fakeCanvases);

it("a saved picture has the mark in its corner, and each force's figure at its place, in the picture's own pixels", () => {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [2000, 1000];
  const labels = [
    { label: { text: "1.2 N", tip: [0, 0, 0] as const, felt: true }, left: 100, top: 50 },
    { label: { text: "0.4 N", tip: [0, 0, 0] as const, felt: false }, left: 10, top: 5 },
  ];
  const saved = savedPicture(canvas, "Recording", labels, 500); // twice the pixels of the style sheet
  const written = drawnOn(saved).filter(({ what }) => what === "fillText");
  expect(written.map(({ values }) => values)).toEqual([["Recording", 50, 100], ["1.2 N", 200, 126], ["0.4 N", 20, 36]]);
  expect(written[1]!.font).toContain("24px");
  expect(written[2]!.font, "computed, not felt").toContain("italic");
});

it("is the canvas itself where there is nothing to add", () => {
  const canvas = document.createElement("canvas");
  expect(savedPicture(canvas, "", [], 500)).toBe(canvas);
});
