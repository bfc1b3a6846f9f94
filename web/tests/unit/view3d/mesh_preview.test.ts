// SPDX-License-Identifier: Apache-2.0
// A browser that cannot draw: happy-dom has no WebGL.
import { afterEach, expect, it, vi } from "vitest";
import { MeshPreviewView } from "../../../src/view3d/mesh_preview";

afterEach(() => vi.restoreAllMocks());

it("without WebGL says so once, and everything else does nothing and does not throw", () => {
  vi.spyOn(console, "error").mockImplementation(() => {}); // three.js complains there as well
  const troubles: string[] = [];
  const host = document.createElement("div");
  const mesh = { position: Float32Array.from([0, 0, 0, 0.06, 0, 0, 0, 0.04, 0]), index: Uint32Array.from([0, 1, 2]) };
  const view = new MeshPreviewView(host, mesh, (what) => troubles.push(what));
  view.setTheme("light");
  view.setUp("y");
  const before = view.probe().direction;
  view.orbit(0.1, 0.1);
  expect(view.probe()).toMatchObject({ frames: 0, up: "y", bar: 0.1 });
  expect(view.probe().direction).not.toEqual(before);
  expect(troubles).toEqual(["no-webgl"]);
  view.dispose();
  expect(host.childElementCount).toBe(0);
});
