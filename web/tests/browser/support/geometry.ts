// SPDX-License-Identifier: Apache-2.0

export type Point = readonly [number, number, number];

/// Origins of the frames of poses, seven numbers each as in Tick [m].
export function origins(poses: readonly number[]): Point[] {
  return Array.from({ length: Math.floor(poses.length / 7) }, (_, i) => [poses[7 * i]!, poses[7 * i + 1]!, poses[7 * i + 2]!] as const);
}

export const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const distance = (a: Point, b: Point): number => Math.hypot(...minus(a, b));
export const cross = (a: Point, b: Point): Point => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const dot = (a: Point, b: Point): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
