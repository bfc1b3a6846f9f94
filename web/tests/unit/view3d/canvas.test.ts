// SPDX-License-Identifier: Apache-2.0
import { expect, it, vi } from "vitest";
import { Canvas } from "../../../src/view3d/canvas";

const told: string[] = [];
vi.mock("three", async (original) => ({
  ...(await original<typeof import("three")>()),
  WebGLRenderer: class {
    readonly domElement = document.createElement("canvas");
    readonly shadowMap = {};
    dispose = () => void told.push("renderer gone");
    forceContextLoss = () => {};
    getContext = () => ({ isContextLost: () => false });
  },
}));

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
