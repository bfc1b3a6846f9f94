// SPDX-License-Identifier: Apache-2.0
import { SphereGeometry } from "three";
import { describe, expect, it } from "vitest";
import { creaseNormals } from "../../../src/view3d/crease_normals";

const degree = Math.PI / 180;
const cube = {
  position: [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1],
  index: [0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 2, 3, 7, 2, 7, 6, 1, 2, 6, 1, 6, 5, 3, 0, 4, 3, 4, 7],
};

function normalOf(normal: Float32Array, vertex: number): number[] {
  return Array.from(normal.subarray(3 * vertex, 3 * vertex + 3));
}

describe("creaseNormals", () => {
  it("breaks a cube at its edges: three copies of each corner, all normals along an axis", () => {
    const shaded = creaseNormals(cube.position, cube.index, 38 * degree);
    expect(shaded.source.length).toBe(24);
    for (let i = 0; i < 24; ++i) {
      expect(normalOf(shaded.normal, i).map(Math.abs).sort()).toEqual([0, 0, 1]);
    }
  });
  it("keeps a vertex whole below the crease: the corner's normal is the diagonal", () => {
    const shaded = creaseNormals(cube.position, cube.index, Math.PI);
    expect(Array.from(shaded.source)).toEqual([0, 1, 2, 3, 4, 5, 6, 7]);
    for (const part of normalOf(shaded.normal, 6)) expect(part).toBeCloseTo(1 / Math.sqrt(3), 6);
  });
  it("does not depend on how a flat side is cut into triangles", () => {
    const shaded = creaseNormals(cube.position, cube.index, 100 * degree); // all three sides meet smoothly
    for (const part of normalOf(shaded.normal, 0)) expect(part).toBeCloseTo(-1 / Math.sqrt(3), 6);
  });
  it("is smooth over a ball, where each normal points away from the middle", () => {
    const ball = new SphereGeometry(1, 32, 24);
    const shaded = creaseNormals(ball.getAttribute("position").array, ball.getIndex()!.array, 40 * degree);
    for (let i = 0; i < shaded.source.length; ++i) {
      let along = 0;
      for (let k = 0; k < 3; ++k) along += shaded.position[3 * i + k]! * shaded.normal[3 * i + k]!;
      expect(along).toBeGreaterThan(0.98);
    }
  });
  it("keeps each triangle's place and winding", () => {
    const shaded = creaseNormals(cube.position, cube.index, 38 * degree);
    expect(Array.from(shaded.index, (vertex) => shaded.source[vertex])).toEqual(cube.index);
  });
  it("leaves out triangles without area and with vertices that are not there", () => {
    const shaded = creaseNormals(cube.position, [0, 0, 1, 0, 1, 99, 0, 2, 1, 5], Math.PI);
    expect(shaded.index.length).toBe(3);
    expect(Array.from(shaded.normal)).not.toContain(NaN);
  });
  it("makes nothing of nothing", () => {
    expect(creaseNormals([], [], 1).index.length).toBe(0);
  });
});
