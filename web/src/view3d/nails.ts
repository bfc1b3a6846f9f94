// SPDX-License-Identifier: Apache-2.0
// Nails: a curved plate on the back of each tip, laid on the skin of the bind pose. Its middle is above the skin, its border below.
import { Vector3 } from "three";
import { isTip, type BoundHand } from "./skin_detail";
import { kSegments } from "./segments";

export interface Nails {
  readonly position: readonly number[]; // 3 a vertex, frame B
  readonly normal: readonly number[];
  readonly detail: readonly number[]; // kDetail a vertex
  readonly segment: readonly number[]; // of each vertex
  readonly index: readonly number[]; // into these vertices
}

const kRows = 12; // from the root to the free edge
const kColumns = 11;
const kFrom = 0.46; // of the segment's length
const kTo = 0.95;
const kWidth = 0.78; // of the tip's
const kThick = 0.2e-3; // above the skin [m]
const kSmoothings = 12;
const kSunk = 0.5e-3; // of the border below the skin [m]

interface Skin {
  readonly position: ArrayLike<number>;
  readonly index: ArrayLike<number>;
}

/// @param owner  of each vertex: the segment that has most of it
export function nailsOn(hand: BoundHand, skin: Skin, owner: ArrayLike<number>): Nails {
  const nails: Record<keyof Nails, number[]> = { position: [], normal: [], detail: [], segment: [], index: [] };
  for (let segment = 0; segment < kSegments; ++segment) {
    const heights = isTip(segment) ? layOn(hand, skin, owner, segment) : null;
    if (heights) addNail(nails, hand, segment, heights);
  }
  return nails;
}

/// Grid of points in the segment's frame S, on the skin. Null: there is no skin under part of it.
function layOn(hand: BoundHand, { position, index }: Skin, owner: ArrayLike<number>, segment: number): Vector3[] | null {
  const length = hand.lengths[segment]!;
  const inverse = hand.inverses[segment]!;
  const corners: Vector3[] = []; // 3 a triangle of the tip
  for (let i = 0; i < index.length; i += 3) {
    if (![0, 1, 2].some((k) => owner[index[i + k]!] === segment)) continue;
    for (let k = 0; k < 3; ++k) corners.push(new Vector3().fromArray(position, 3 * index[i + k]!).applyMatrix4(inverse));
  }
  const along = (row: number): number => -length * (kFrom + ((kTo - kFrom) * row) / (kRows - 1));
  const wide = corners.filter(({ z }) => z < -0.5 * length && z > -0.75 * length).map(({ x }) => x);
  if (wide.length === 0) return null;
  const [low, high] = [Math.min(...wide), Math.max(...wide)];
  const grid: Vector3[] = [];
  for (let row = 0; row < kRows; ++row) {
    for (let column = 0; column < kColumns; ++column) {
      const x = (low + high) / 2 + ((high - low) / 2) * kWidth * outline(row / (kRows - 1)) * ((2 * column) / (kColumns - 1) - 1);
      const y = heightAt(corners, x, along(row));
      if (y === null) return null;
      grid.push(new Vector3(x, y, along(row)));
    }
  }
  return grid;
}

/// Half width at a place from root (0) to free edge (1), of the largest: both ends are round.
function outline(at: number): number {
  const root = Math.max(0, 1 - at / 0.35);
  const edge = Math.max(0, (at - 0.72) / 0.28);
  return Math.sqrt(1 - 0.7 * root * root) * Math.sqrt(1 - 0.75 * edge * edge);
}

/// The highest point of the triangles there, seen from the back.
function heightAt(corners: readonly Vector3[], x: number, z: number): number | null {
  let highest: number | null = null;
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [corners[i]!, corners[i + 1]!, corners[i + 2]!];
    const area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
    if (Math.abs(area) < 1e-14) continue;
    const u = ((x - a.x) * (c.z - a.z) - (c.x - a.x) * (z - a.z)) / area;
    const v = ((b.x - a.x) * (z - a.z) - (x - a.x) * (b.z - a.z)) / area;
    if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
    const y = a.y + u * (b.y - a.y) + v * (c.y - a.y);
    if (highest === null || y > highest) highest = y;
  }
  return highest;
}

/// @param skin  the grid that the nail lies on
function addNail(nails: Record<keyof Nails, number[]>, hand: BoundHand, segment: number, skin: readonly Vector3[]): void {
  const first = nails.segment.length;
  const surface = plate(skin);
  const frame = hand.frames[segment]!;
  for (let row = 0; row < kRows; ++row) {
    for (let column = 0; column < kColumns; ++column) {
      const at = surface[row * kColumns + column]!;
      nails.normal.push(...normalAt(surface, row, column).transformDirection(frame).toArray());
      nails.position.push(...at.clone().applyMatrix4(frame).toArray());
      nails.detail.push(row / (kRows - 1), (2 * column) / (kColumns - 1) - 1, 0, 1);
      nails.segment.push(segment);
      if (row === 0 || column === 0) continue;
      const [a, b, c, d] = [-kColumns - 1, -kColumns, -1, 0].map((step) => first + row * kColumns + column + step) as [number, number, number, number];
      nails.index.push(a, b, d, a, d, c);
    }
  }
}

/// The skin's heights smoothed and lifted until all but the border is above the skin; the border is below it.
function plate(skin: readonly Vector3[]): Vector3[] {
  let heights = skin.map(({ y }) => y);
  for (let round = 0; round < kSmoothings; ++round) heights = smoothed(heights, round % 2 === 0 ? 1 : kColumns);
  const isBorder = (i: number): boolean => i < kColumns || i >= (kRows - 1) * kColumns || i % kColumns === 0 || i % kColumns === kColumns - 1;
  const short = skin.map((point, i) => (isBorder(i) ? 0 : point.y - heights[i]!));
  const lift = Math.max(0, ...short) + kThick;
  return skin.map((point, i) => new Vector3(point.x, isBorder(i) ? point.y - kSunk : heights[i]! + lift, point.z));
}

/// Along rows (step 1) or columns; straight on at the ends.
function smoothed(heights: readonly number[], step: number): number[] {
  return heights.map((height, i) => {
    const place = step === 1 ? i % kColumns : Math.floor(i / kColumns);
    const last = (step === 1 ? kColumns : kRows) - 1;
    if (place === 0 || place === last) return height;
    return (2 * height + heights[i - step]! + heights[i + step]!) / 4;
  });
}

function normalAt(surface: readonly Vector3[], row: number, column: number): Vector3 {
  const inside = (n: number, most: number): number => Math.min(most - 2, Math.max(1, n)); // the border's is that of its neighbour
  const [r, c] = [inside(row, kRows), inside(column, kColumns)];
  const get = (a: number, b: number): Vector3 => surface[Math.min(kRows - 2, Math.max(1, a)) * kColumns + Math.min(kColumns - 2, Math.max(1, b))]!;
  const across = get(r, c + 1).clone().sub(get(r, c - 1));
  const along = get(r + 1, c).clone().sub(get(r - 1, c));
  const normal = new Vector3().crossVectors(along, across).normalize();
  return normal.y < 0 ? normal.negate() : normal;
}
