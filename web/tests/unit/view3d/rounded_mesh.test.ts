// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { roundedMesh } from "../../../src/view3d/rounded_mesh";

describe("roundedMesh", () => {
  const position = [1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1];
  const octahedron = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5];

  it("makes four triangles of one and shares what is new: 6 vertices and 12 edges become 18 vertices", () => {
    const fine = roundedMesh(position, position, octahedron);
    expect(fine.index.length).toBe(4 * octahedron.length);
    expect(fine.position.length / 3).toBe(18);
  });
  it("stays closed: each edge is there once in each direction", () => {
    const { index } = roundedMesh(position, position, octahedron);
    const edges = new Set<string>();
    for (let i = 0; i < index.length; i += 3) {
      for (let k = 0; k < 3; ++k) edges.add(`${index[i + k]} ${index[i + ((k + 1) % 3)]}`);
    }
    expect(edges.size).toBe(index.length);
    for (const edge of edges) expect(edges.has(edge.split(" ").reverse().join(" "))).toBe(true);
  });
  it("pulls an edge's middle outwards: by hand, (1/2 1/2 0) goes to (11/16 11/16 0)", () => {
    // Height over either tangent plane is -1/2; each moves by 3/8 * 1/2 along its own axis.
    const fine = roundedMesh(position, position, octahedron);
    const i = Array.from({ length: 18 }, (_, v) => v).find((v) => fine.ends[2 * v] === 0 && fine.ends[2 * v + 1] === 2)!;
    expect(Array.from(fine.position.subarray(3 * i, 3 * i + 3))).toEqual([0.6875, 0.6875, 0]);
  });
  it("leaves a flat mesh flat, and the coarse vertices where they were", () => {
    const flat = [0, 0, 0, 2, 0, 0, 0, 2, 0];
    const fine = roundedMesh(flat, [0, 0, 1, 0, 0, 1, 0, 0, 1], [0, 1, 2]);
    expect(Array.from(fine.position)).toEqual([...flat, 1, 0, 0, 1, 1, 0, 0, 1, 0]);
  });
  it("comes nearer to a ball: no vertex is more than 5 % inside", () => {
    const fine = roundedMesh(position, position, octahedron);
    for (let i = 0; i < fine.position.length; i += 3) {
      expect(Math.hypot(fine.position[i]!, fine.position[i + 1]!, fine.position[i + 2]!)).toBeGreaterThan(0.95);
    }
  });
});
