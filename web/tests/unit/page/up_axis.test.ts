// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { usualUpAxis } from "../../../src/state/up_axis";

it("only a .glb has another axis up than z", () => {
  expect(["a.glb", "A.GLB", "mug.glb.stl", "a.obj", "a.ply", "a.3ds", "", "glb"].map(usualUpAxis)).toEqual(["y", "y", "z", "z", "z", "z", "z", "z"]);
});
