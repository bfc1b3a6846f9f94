// SPDX-License-Identifier: Apache-2.0
// A finer mesh of the object for display, beside the one that the hand touches: curved PN triangles (Vlachos et al. 2001), cut in four
// again and again. Every vertex of the contact mesh stays where it is. Creases stay: a crease between two smooth parts is a curve along
// the tangents of both, one that ends in a corner is straight there. What is new stays near the contact mesh.
import type { ShadedMesh } from "./crease_normals";

export interface DisplayMesh {
  readonly position: Float32Array; // 3 a vertex; those of the contact mesh come first
  readonly normal: Float32Array; // 3 a vertex, unit
  readonly index: Uint32Array; // 3 a triangle
}

export const kMostTriangles = 60_000;
const kFarthest = 0.5e-3; // [m] from the contact mesh
const kFarthestShare = 0.01; // of the mesh's largest extent
const kRound = 0.05e-3; // [m] an edge that is nearer to its curve looks round
const kRoughShare = 0.02; // of the edges; fewer that do not look round are left

/// Largest distance of the display mesh from the contact mesh [m].
export function displayBound(position: ArrayLike<number>): number {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < position.length; ++i) {
    low[i % 3] = Math.min(low[i % 3]!, position[i]!);
    high[i % 3] = Math.max(high[i % 3]!, position[i]!);
  }
  const size = Math.max(0, ...high.map((x, k) => x - low[k]!));
  return Math.min(kFarthest, kFarthestShare * size);
}

/// Null: the contact mesh looks round as it is, or is too fine to be made finer.
export function displayMesh(mesh: ShadedMesh): DisplayMesh | null {
  let move = displayBound(mesh.position) / 2; // 1/2 + 1/4 + ...: together never more than the bound
  let fine = new Refinement(Array.from(mesh.position), Array.from(mesh.normal), Array.from(mesh.source), mesh.index);
  while (4 * (fine.index.length / 3) <= kMostTriangles && fine.rough()) {
    fine = fine.refined(move);
    move /= 2;
  }
  if (fine.index === mesh.index) return null;
  return { position: Float32Array.from(fine.position), normal: Float32Array.from(fine.normal), index: fine.index };
}

type Vector = readonly [number, number, number];

/// Copies of the ends of an edge, one pair for each side of it; two pairs that differ: a crease.
interface Edge {
  readonly ends: readonly [number, number]; // points
  readonly sides: (readonly [number, number])[]; // vertices, in the order of `ends`
}

class Refinement {
  private readonly copies = new Map<number, number[]>(); // of each point: its vertices
  private readonly edges = new Map<number, Edge>();

  /// @param point  of each vertex; those at a crease are copies of one point
  constructor(readonly position: number[], readonly normal: number[], private readonly point: number[], readonly index: Uint32Array) {
    point.forEach((at, vertex) => {
      const known = this.copies.get(at);
      if (known) known.push(vertex);
      else this.copies.set(at, [vertex]);
    });
    for (let i = 0; i < index.length; i += 3) {
      for (let k = 0; k < 3; ++k) this.addSide(index[i + k]!, index[i + ((k + 1) % 3)]!);
    }
  }

  rough(): boolean {
    let count = 0;
    for (const edge of this.edges.values()) if (Math.hypot(...this.bulge(edge)) > kRound) ++count;
    return count > kRoughShare * this.edges.size;
  }

  /// @param farthest  from an edge's middle to what takes its place [m]
  refined(farthest: number): Refinement {
    const position = [...this.position];
    const normal = [...this.normal];
    const point = [...this.point];
    const middles = new Map<number, number>(); // by the pair of vertices
    let points = 1 + this.point.reduce((most, one) => Math.max(most, one), -1);
    for (const edge of this.edges.values()) {
      const bulge = this.bulge(edge);
      const shrink = Math.min(1, farthest / Math.max(1e-12, Math.hypot(...bulge)));
      const at = points++;
      for (const [a, b] of edge.sides) {
        const key = this.pair(a, b);
        if (middles.has(key)) continue;
        middles.set(key, point.length);
        point.push(at);
        const [p, q] = [this.at(a), this.at(b)];
        for (const k of [0, 1, 2] as const) position.push((p[k] + q[k]) / 2 + shrink * bulge[k]);
        normal.push(...this.middleNormal(a, b));
      }
    }
    const index = new Uint32Array(4 * this.index.length);
    for (let i = 0; i < this.index.length; i += 3) {
      const [a, b, c] = [this.index[i]!, this.index[i + 1]!, this.index[i + 2]!];
      const [ab, bc, ca] = [middles.get(this.pair(a, b))!, middles.get(this.pair(b, c))!, middles.get(this.pair(c, a))!];
      index.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], 4 * i);
    }
    return new Refinement(position, normal, point, index);
  }

  private addSide(a: number, b: number): void {
    const [p, q] = [this.point[a]!, this.point[b]!];
    const key = Math.min(p, q) * this.point.length + Math.max(p, q);
    const side = p < q ? ([a, b] as const) : ([b, a] as const);
    const known = this.edges.get(key);
    if (known) known.sides.push(side);
    else this.edges.set(key, { ends: [Math.min(p, q), Math.max(p, q)], sides: [side] });
  }

  /// From the middle of the edge to the middle of its curve, the same for all sides.
  private bulge({ ends, sides }: Edge): Vector {
    const [a, b] = sides[0]!;
    const [p, q] = [this.at(a), this.at(b)];
    const along: Vector = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
    const from = this.tangent(ends[0], sides.map((side) => side[0]), along);
    const to = this.tangent(ends[1], sides.map((side) => side[1]), along);
    return [(from[0] - to[0]) / 8, (from[1] - to[1]) / 8, (from[2] - to[2]) / 8];
  }

  /// The edge's vector where its curve leaves a point: in the tangent plane, at a crease along it.
  private tangent(point: number, vertices: readonly number[], along: Vector): Vector {
    if (vertices.every((vertex) => vertex === vertices[0])) {
      const n = this.normalAt(vertices[0]!);
      const height = dot(along, n);
      return [along[0] - height * n[0], along[1] - height * n[1], along[2] - height * n[2]];
    }
    const copies = this.copies.get(point)!;
    if (copies.length !== 2) return along;
    const [m, n] = [this.normalAt(copies[0]!), this.normalAt(copies[1]!)];
    const line: Vector = [m[1] * n[2] - m[2] * n[1], m[2] * n[0] - m[0] * n[2], m[0] * n[1] - m[1] * n[0]];
    const square = dot(line, line);
    if (square < 1e-6) return along;
    const share = dot(along, line) / square;
    return [share * line[0], share * line[1], share * line[2]];
  }

  /// Quadratic, as of PN triangles: between two equal normals of an S-shaped edge it turns away from both.
  private middleNormal(a: number, b: number): Vector {
    const [p, q, m, n] = [this.at(a), this.at(b), this.normalAt(a), this.normalAt(b)];
    const along: Vector = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
    const sum: Vector = [m[0] + n[0], m[1] + n[1], m[2] + n[2]];
    const turn = (2 * dot(along, sum)) / Math.max(1e-18, dot(along, along));
    const control = unit([sum[0] - turn * along[0], sum[1] - turn * along[1], sum[2] - turn * along[2]]);
    return unit([sum[0] + 2 * control[0], sum[1] + 2 * control[1], sum[2] + 2 * control[2]]);
  }

  private pair(a: number, b: number): number {
    return Math.min(a, b) * this.point.length + Math.max(a, b);
  }

  private at(vertex: number): Vector {
    return [this.position[3 * vertex]!, this.position[3 * vertex + 1]!, this.position[3 * vertex + 2]!];
  }

  private normalAt(vertex: number): Vector {
    return [this.normal[3 * vertex]!, this.normal[3 * vertex + 1]!, this.normal[3 * vertex + 2]!];
  }
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function unit(a: Vector): Vector {
  const length = Math.hypot(...a);
  return length > 1e-12 ? [a[0] / length, a[1] / length, a[2] / length] : [0, 0, 1];
}
