// SPDX-License-Identifier: Apache-2.0
import { SphereGeometry, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { creaseNormals } from "../../../src/view3d/crease_normals";
import { random as seeded } from "../page/random";

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
  it("groups as comparing all pairs at each vertex would: 200 seeded soups", () => {
    const random = seeded(20261122);
    for (let round = 0; round < 200; ++round) {
      const vertices = 4 + Math.floor(8 * random());
      const position = Array.from({ length: 3 * vertices }, () => random());
      const index = Array.from({ length: 3 * Math.floor(30 * random()) }, () => Math.floor(vertices * random()));
      const crease = Math.PI * random();
      const shaded = creaseNormals(position, index, crease);
      const kept = Array.from(shaded.index, (vertex) => shaded.source[vertex]!); // triangles without area are gone
      const copies = allPairs(position, kept, crease);
      const pairs = new Set(kept.map((_, corner) => `${copies[corner]}: ${shaded.index[corner]}`));
      expect(pairs.size, `round ${round}`).toBe(new Set(copies).size); // each group has one copy,
      expect(pairs.size, `round ${round}`).toBe(shaded.source.length); // and each copy one group
    }
  });
  it("ends where 100,000 triangles meet in one point, all of them in one group or each in its own", () => {
    const flat = creaseNormals(...fan(100_000, 0), 38 * degree);
    expect(flat.source.filter((vertex) => vertex === 0).length).toBe(1);
    expect(normalOf(flat.normal, 0)).toEqual([0, 0, 1]);
    const folded = creaseNormals(...fan(100_000, 1), 38 * degree);
    expect(folded.source.filter((vertex) => vertex === 0).length).toBe(100_000);
  });
  it("ends where 100,000 triangles meet in one edge: they are one group there", () => {
    const count = 100_000;
    const position = [0, 0, 0, 0, 0, 1];
    const index: number[] = [];
    for (let i = 0; i < count; ++i) {
      position.push(Math.cos(i), Math.sin(i), 0.5);
      index.push(0, 1, i + 2);
    }
    const shaded = creaseNormals(position, index, 38 * degree);
    expect(shaded.source.filter((vertex) => vertex === 0).length).toBe(1);
  });
  it("makes nothing of nothing", () => {
    expect(creaseNormals([], [], 1).index.length).toBe(0);
  });
});

/// Triangles around vertex 0; every other rim vertex is lifted by `fold`.
function fan(count: number, fold: number): [number[], number[]] {
  const position = [0, 0, 0];
  const index: number[] = [];
  for (let i = 0; i < count; ++i) {
    const angle = (2 * Math.PI * i) / count;
    position.push(Math.cos(angle), Math.sin(angle), i % 2 === 0 ? 0 : fold);
    index.push(0, i + 1, ((i + 1) % count) + 1);
  }
  return [position, index];
}

/// For each corner the name of its group, found by comparing all pairs of triangles at its vertex.
function allPairs(position: readonly number[], index: readonly number[], crease: number): string[] {
  const group = index.map((_, corner) => corner);
  const points = Float32Array.from(position);
  const unit = (face: number): Vector3 => {
    const [a, b, c] = [0, 1, 2].map((k) => new Vector3().fromArray(points, 3 * index[face + k]!)) as [Vector3, Vector3, Vector3];
    return b.sub(a).cross(c.sub(a)).normalize();
  };
  for (let a = 0; a < index.length; ++a) {
    for (let b = 0; b < a; ++b) {
      if (index[a] !== index[b]) continue;
      const [p, q] = [a - (a % 3), b - (b % 3)];
      const others = index.slice(q, q + 3).filter((vertex) => vertex !== index[a]);
      const share = index.slice(p, p + 3).some((vertex) => vertex !== index[a] && others.includes(vertex));
      if (!share || unit(p).dot(unit(q)) < Math.cos(crease)) continue;
      const [from, to] = [group[a]!, group[b]!];
      group.forEach((one, corner) => one === from && (group[corner] = to));
    }
  }
  return group.map((one, corner) => `${index[corner]} ${one}`);
}
