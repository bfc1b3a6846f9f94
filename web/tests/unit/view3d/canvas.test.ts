// SPDX-License-Identifier: Apache-2.0
import { afterAll, beforeAll, expect, it, vi } from "vitest";
import type { Canvas as CanvasClass } from "../../../src/view3d/canvas";

const told: string[] = [];
let Canvas: typeof CanvasClass;

// Other files of the same process have the module with the real three.js.
beforeAll(async () => {
  vi.resetModules();
  vi.doMock("three", async (original) => ({
    ...(await original<typeof import("three")>()),
    WebGLRenderer: class {
      readonly domElement = document.createElement("canvas");
      readonly shadowMap = {};
      dispose = () => void told.push("renderer gone");
      forceContextLoss = () => {};
      getContext = () => ({ isContextLost: () => false });
    },
  }));
  ({ Canvas } = await import("../../../src/view3d/canvas"));
});
afterAll(() => {
  vi.doUnmock("three");
  vi.resetModules();
});

it("lets go of what a renderer has drawn before each time that another kind takes its place", () => {
  const surface = document.createElement("div");
  const canvas = new Canvas(surface, () => {}, () => void told.push("let go"), () => {});
  canvas.use(true);
  canvas.use(true); // the same kind
  expect(told).toEqual([]);
  for (let swings = 1; swings <= 3; ++swings) {
    canvas.use(false);
    canvas.use(true);
    expect(told).toEqual(Array.from({ length: 2 * swings }, () => ["let go", "renderer gone"]).flat());
    expect(surface.childElementCount).toBe(1);
  }
});
