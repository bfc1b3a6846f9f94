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

type Quaternion = readonly [u: Point, w: number];

const product = ([u, w]: Quaternion, [v, s]: Quaternion): Quaternion => [plus(cross(u, v), plus(times(s, u), times(w, v))), w * s - dot(u, v)];
const scaled = (factor: number, [u, w]: Quaternion): Quaternion => [times(factor, u), factor * w];

/// Origin and quaternion of a segment's pose.
function poseOf(poses: readonly number[], segment: number): [Point, Quaternion] {
  const [x, y, z, i, j, k, w] = poses.slice(7 * segment, 7 * segment + 7) as [number, number, number, number, number, number, number];
  return [[x, y, z], [[i, j, k], w]];
}

/// R_WS R_BS^-1, with the sign that is nearer to the segment before.
function rotationOf(poses: readonly number[], bind: readonly number[], segment: number): Quaternion {
  const [, [u, w]] = poseOf(bind, segment);
  const rotation = product(poseOf(poses, segment)[1], [times(-1, u), w]);
  if (segment === 15) return rotation;
  const before = rotationOf(poses, bind, segment % 3 === 0 ? 15 : segment - 1);
  return scaled(dot(rotation[0], before[0]) + rotation[1] * before[1] < 0 ? -1 : 1, rotation);
}

/// Where a vertex of the skin is at segment poses X_WS: about its centre of rotation, as geometry.proto defines it [m].
export function skinAt(skin: Skin, poses: readonly number[], vertex: number): Point {
  const p = skin.mesh!.position.slice(3 * vertex, 3 * vertex + 3) as unknown as Point;
  const influences = [0, 1, 2, 3].map((k) => [skin.segment[4 * vertex + k]!, skin.weight[4 * vertex + k]!] as const);
  let [feet, total]: [Point, number] = [[0, 0, 0], 0];
  for (const [segment, weight] of influences.filter(([segment]) => segment !== 15)) {
    const [origin, rotation] = poseOf(skin.bindPose, segment);
    const axis = turned(...rotation, [0, 0, 1]);
    feet = plus(feet, times(weight, plus(origin, times(dot(axis, minus(p, origin)), axis))));
    total += weight;
  }
  const centre = total > 0 ? times(1 / total, feet) : p;
  let sum: Quaternion = [[0, 0, 0], 0];
  let moved: Point = [0, 0, 0];
  for (const [segment, weight] of influences) {
    const rotation = rotationOf(poses, skin.bindPose, segment);
    sum = [plus(sum[0], times(weight, rotation[0])), sum[1] + weight * rotation[1]];
    const arm = minus(centre, poseOf(skin.bindPose, segment)[0]);
    moved = plus(moved, times(weight, plus(poseOf(poses, segment)[0], turned(...rotation, arm))));
  }
  return plus(moved, turned(...scaled(1 / Math.hypot(...sum[0], sum[1]), sum), minus(p, centre)));
}

/// Volume inside a closed surface [m^3]; negative where it is inside out.
export function volume(position: readonly number[], index: readonly number[]): number {
  const at = (vertex: number): Point => [position[3 * vertex]!, position[3 * vertex + 1]!, position[3 * vertex + 2]!];
  let six = 0;
  for (let i = 0; i + 2 < index.length; i += 3) six += dot(at(index[i]!), cross(at(index[i + 1]!), at(index[i + 2]!)));
  return six / 6;
}
