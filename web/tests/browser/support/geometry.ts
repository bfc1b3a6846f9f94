// SPDX-License-Identifier: Apache-2.0
// Points and poses, worked out without any code of the page's.
import type { Skin } from "../../../src/gen/phalanx/geometry_pb";

export type Point = readonly [number, number, number];

/// Origins of the frames of poses, seven numbers each as in Tick [m].
export function origins(poses: readonly number[]): Point[] {
  return Array.from({ length: Math.floor(poses.length / 7) }, (_, i) => [poses[7 * i]!, poses[7 * i + 1]!, poses[7 * i + 2]!] as const);
}

export const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const distance = (a: Point, b: Point): number => Math.hypot(...minus(a, b));
export const cross = (a: Point, b: Point): Point => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const dot = (a: Point, b: Point): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a: Point, b: Point): Point => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const times = (factor: number, a: Point): Point => [factor * a[0], factor * a[1], factor * a[2]];

/// q p q*, with q = (u, w): p + 2 w u x p + 2 u x (u x p)
function turned(u: Point, w: number, p: Point): Point {
  const once = times(2, cross(u, p));
  return plus(p, plus(times(w, once), cross(u, once)));
}

/// X_WS X_BS^-1 p, with both X number `segment` of their poses.
function carried(poses: readonly number[], bind: readonly number[], segment: number, p: Point): Point {
  const [x, y, z, i, j, k, w] = poses.slice(7 * segment, 7 * segment + 7) as [number, number, number, number, number, number, number];
  const [bx, by, bz, bi, bj, bk, bw] = bind.slice(7 * segment, 7 * segment + 7) as [number, number, number, number, number, number, number];
  return plus([x, y, z], turned([i, j, k], w, turned([-bi, -bj, -bk], bw, minus(p, [bx, by, bz]))));
}

/// Where a vertex of the skin is at segment poses X_WS: linear blend skinning as geometry.proto defines it [m].
export function skinAt(skin: Skin, poses: readonly number[], vertex: number): Point {
  const { position } = skin.mesh!;
  const p: Point = [position[3 * vertex]!, position[3 * vertex + 1]!, position[3 * vertex + 2]!];
  return [0, 1, 2, 3].reduce<Point>((sum, k) => {
    const [segment, weight] = [skin.segment[4 * vertex + k]!, skin.weight[4 * vertex + k]!];
    return plus(sum, times(weight, carried(poses, skin.bindPose, segment, p)));
  }, [0, 0, 0]);
}

/// Volume inside a closed surface [m^3]; negative where it is inside out.
export function volume(position: readonly number[], index: readonly number[]): number {
  const at = (vertex: number): Point => [position[3 * vertex]!, position[3 * vertex + 1]!, position[3 * vertex + 2]!];
  let six = 0;
  for (let i = 0; i + 2 < index.length; i += 3) six += dot(at(index[i]!), cross(at(index[i + 1]!), at(index[i + 2]!)));
  return six / 6;
}
