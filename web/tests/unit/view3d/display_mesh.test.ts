// SPDX-License-Identifier: Apache-2.0
import { BoxGeometry, CylinderGeometry, IcosahedronGeometry, SphereGeometry, Triangle, Vector3 } from "three";
import type { BufferGeometry } from "three";
import { mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";
import { describe, expect, it } from "vitest";
import { creaseNormals, type ShadedMesh } from "../../../src/view3d/crease_normals";
import { displayBound, displayMesh, kMostTriangles, type DisplayMesh } from "../../../src/view3d/display_mesh";

const kCrease = (38 * Math.PI) / 180;

/// Without normals and texture, so that vertices at seams are one.
function shaded(shape: BufferGeometry): ShadedMesh {
  shape.deleteAttribute("normal");
  shape.deleteAttribute("uv");
  const whole = mergeVertices(shape, 1e-7);
  return creaseNormals(whole.getAttribute("position").array, whole.getIndex()!.array, kCrease);
}

function distanceTo(mesh: ShadedMesh, point: Vector3): number {
  const [closest, at] = [new Vector3(), (i: number) => new Vector3().fromArray(mesh.position, 3 * i)];
  let least = Infinity;
  for (let i = 0; i < mesh.index.length; i += 3) {
    new Triangle(at(mesh.index[i]!), at(mesh.index[i + 1]!), at(mesh.index[i + 2]!)).closestPointToPoint(point, closest);
    least = Math.min(least, closest.distanceTo(point));
  }
  return least;
}

/// Each edge between two places is there as often in one direction as in the other.
function expectClosed({ position, index }: DisplayMesh): void {
  const place = (i: number): string => [0, 1, 2].map((k) => position[3 * i + k]!.toFixed(9)).join(" ");
  const edges = new Map<string, number>();
  for (let i = 0; i < index.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [place(index[i + k]!), place(index[i + ((k + 1) % 3)]!)];
      edges.set(`${a},${b}`, (edges.get(`${a},${b}`) ?? 0) + 1);
    }
  }
  for (const [edge, count] of edges) expect(edges.get(edge.split(",").reverse().join(","))).toBe(count);
}

describe("displayMesh", () => {
  it("keeps every vertex of the contact mesh, its normal too", () => {
    const ball = shaded(new IcosahedronGeometry(0.04, 2));
    const fine = displayMesh(ball)!;
    expect([...fine.position.subarray(0, ball.position.length)]).toEqual([...ball.position]);
    expect([...fine.normal.subarray(0, ball.normal.length)]).toEqual([...ball.normal]);
  });
  it("is closed, rounder than the contact mesh, and within the bound of it", () => {
    const radius = 0.04;
    const ball = shaded(new SphereGeometry(radius, 16, 12));
    const fine = displayMesh(ball)!;
    expectClosed(fine);
    const bound = displayBound(ball.position);
    expect(bound).toBeCloseTo(0.0005, 9); // 0.8 mm would be 1 % of the size
    let moved = 0;
    for (let i = 0; i < fine.position.length; i += 3) {
      const away = distanceTo(ball, new Vector3().fromArray(fine.position, i));
      expect(away).toBeLessThanOrEqual(bound + 1e-8);
      moved = Math.max(moved, away);
    }
    expect(moved).toBeGreaterThan(0.2e-3);
  });
  it("stays within 1 % of a small object's size", () => {
    const ball = shaded(new IcosahedronGeometry(0.005, 0));
    const bound = displayBound(ball.position);
    expect(bound).toBeLessThan(0.1e-3 + 1e-9);
    const fine = displayMesh(ball);
    for (let i = 0; i < (fine?.position.length ?? 0); i += 3) {
      expect(distanceTo(ball, new Vector3().fromArray(fine!.position, i))).toBeLessThanOrEqual(bound + 1e-8);
    }
  });
  it("keeps creases: the rim of a cylinder is round, its ends stay flat", () => {
    const [radius, height] = [0.03, 0.1];
    const fine = displayMesh(shaded(new CylinderGeometry(radius, radius, height, 24, 1)))!;
    expectClosed(fine);
    let rim = 0;
    for (let i = 0; i < fine.position.length; i += 3) {
      const [x, y, z] = fine.position.subarray(i, i + 3) as unknown as [number, number, number];
      expect(Math.abs(y)).toBeLessThanOrEqual(height / 2 + 1e-7);
      const [nx, ny, nz] = fine.normal.subarray(i, i + 3) as unknown as [number, number, number];
      expect(Math.hypot(nx, ny, nz)).toBeCloseTo(1, 5);
      expect(Math.min(Math.abs(ny), Math.hypot(nx, nz))).toBeLessThan(1e-3); // an end's or the side's, none between them
      if (Math.abs(Math.abs(y) - height / 2) < 1e-7 && Math.abs(ny) < 0.5) {
        ++rim;
        expect(Math.hypot(x, z)).toBeGreaterThan(0.9975 * radius); // of the polygon's edges 0.9914
      }
    }
    expect(rim).toBeGreaterThanOrEqual(2 * 48);
  });
  it("there is none of what is flat, and none of what looks round or would have too many triangles", () => {
    expect(displayMesh(shaded(new BoxGeometry(0.05, 0.06, 0.07)))).toBeNull();
    expect(displayMesh(shaded(new SphereGeometry(0.02, 72, 54)))).toBeNull();
    const large = shaded(new SphereGeometry(2, 100, 84));
    expect(4 * (large.index.length / 3)).toBeGreaterThan(kMostTriangles);
    expect(displayMesh(large)).toBeNull();
  });
  it("never has more triangles than its limit", () => {
    for (const cuts of [6, 30]) {
      const fine = displayMesh(shaded(new SphereGeometry(0.5, 2 * cuts, cuts)));
      expect((fine?.index.length ?? 0) / 3).toBeLessThanOrEqual(kMostTriangles);
    }
  });
});
