// SPDX-License-Identifier: Apache-2.0
// How dark the table is below hand and object: a coarse field over the table, darker the lower something is above it. It is computed by the
// processor, in a fraction of a millisecond, so that every quality has it.
import type { Box3 } from "three";
import type { Capsule } from "./object_material";

export const kShadowEdge = 64; // texels
const kObjectHeight = 0.035; // [m] in which the object's shadow falls to 1/e
const kFingerHeight = 0.045;
const kMostCuts = 48; // of a triangle's side
const kObjectDarkness = 0.62;
const kFingerDarkness = 0.34;

/// A square of the table in W [m].
export interface Square {
  readonly x: number; // of its lower corner
  readonly y: number;
  readonly edge: number;
}

export class ContactShadow {
  readonly texels = new Uint8Array(kShadowEdge * kShadowEdge); // 255: black
  private square: Square = { x: 0, y: 0, edge: 1 };
  private height = 0; // of the table
  private readonly object = new Float32Array(kShadowEdge * kShadowEdge); // lightness that the object leaves, 0 .. 1
  private readonly light = new Float32Array(kShadowEdge * kShadowEdge);

  constructor() {
    this.object.fill(1);
  }

  /// @param position  of the object, 3 numbers a vertex; null: there is none
  lay(square: Square, height: number, position: ArrayLike<number> | null, index: ArrayLike<number> | null): void {
    this.square = square;
    this.height = height;
    const lowest = new Float32Array(kShadowEdge * kShadowEdge).fill(Infinity);
    if (position && index) this.dropTriangles(lowest, position, index);
    lowest.forEach((above, i) => (this.object[i] = above === Infinity ? 1 : 1 - kObjectDarkness * Math.exp(-Math.max(0, above) / kObjectHeight)));
    for (let round = 0; round < 3; ++round) blur(this.object);
    this.cast([]);
  }

  cast(fingers: readonly Capsule[]): void {
    this.light.set(this.object);
    for (const finger of fingers) this.castFinger(finger);
    for (let i = 0; i < this.texels.length; ++i) this.texels[i] = Math.round(255 * (1 - this.light[i]!));
  }

  /// How dark the table is at a place, 0 .. 1.
  darknessAt(x: number, y: number): number {
    const [i, j] = [this.texel(x - this.square.x), this.texel(y - this.square.y)];
    return i < 0 || j < 0 || i >= kShadowEdge || j >= kShadowEdge ? 0 : this.texels[j * kShadowEdge + i]! / 255;
  }

  private texel(along: number): number {
    return Math.floor((along / this.square.edge) * kShadowEdge);
  }

  private castFinger({ from, to, radius }: Capsule): void {
    const { x, y, edge } = this.square;
    const above = Math.max(0, (from[2] + to[2]) / 2 - radius - this.height);
    const dark = kFingerDarkness * Math.exp(-above / kFingerHeight);
    if (dark < 0.01) return;
    const soft = radius + 0.5 * above; // half a shadow's width grows with the height
    const reach = 2.2 * soft;
    const step = edge / kShadowEdge;
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const square = Math.max(1e-12, dx * dx + dy * dy);
    const [i0, i1] = [this.texel(Math.min(from[0], to[0]) - reach - x), this.texel(Math.max(from[0], to[0]) + reach - x)];
    const [j0, j1] = [this.texel(Math.min(from[1], to[1]) - reach - y), this.texel(Math.max(from[1], to[1]) + reach - y)];
    for (let j = Math.max(0, j0); j <= Math.min(kShadowEdge - 1, j1); ++j) {
      for (let i = Math.max(0, i0); i <= Math.min(kShadowEdge - 1, i1); ++i) {
        const [px, py] = [x + (i + 0.5) * step - from[0], y + (j + 0.5) * step - from[1]];
        const share = Math.min(1, Math.max(0, (px * dx + py * dy) / square));
        const away = Math.hypot(px - share * dx, py - share * dy) / soft;
        this.light[j * kShadowEdge + i]! *= 1 - dark * Math.exp(-away * away);
      }
    }
  }

  /// The lowest point above each texel, from points of the triangles, at most a texel apart.
  private dropTriangles(lowest: Float32Array, position: ArrayLike<number>, index: ArrayLike<number>): void {
    const drop = (x: number, y: number, z: number): void => {
      const [i, j] = [this.texel(x - this.square.x), this.texel(y - this.square.y)];
      if (i < 0 || j < 0 || i >= kShadowEdge || j >= kShadowEdge) return;
      const at = j * kShadowEdge + i;
      lowest[at] = Math.min(lowest[at]!, z - this.height);
    };
    for (let t = 0; t + 2 < index.length; t += 3) {
      const a = 3 * index[t]!;
      const side = (corner: number): number[] => [0, 1, 2].map((k) => position[3 * index[t + corner]! + k]! - position[a + k]!);
      const [u, v] = [side(1), side(2)];
      const span = Math.hypot(u[0]!, u[1]!) + Math.hypot(v[0]!, v[1]!);
      const cuts = Math.min(kMostCuts, Math.max(1, Math.ceil((span / this.square.edge) * kShadowEdge)));
      for (let p = 0; p <= cuts; ++p) {
        for (let q = 0; p + q <= cuts; ++q) {
          const at = (k: number): number => position[a + k]! + (p * u[k]! + q * v[k]!) / cuts;
          drop(at(0), at(1), at(2));
        }
      }
    }
  }
}

/// A square around what casts a shadow, with room for hands.
export function squareAround(box: Box3, edge: number): Square {
  return { x: (box.min.x + box.max.x - edge) / 2, y: (box.min.y + box.max.y - edge) / 2, edge };
}

function blur(field: Float32Array): void {
  const before = field.slice();
  const inside = (i: number): number => Math.min(kShadowEdge - 1, Math.max(0, i));
  const row = (i: number, j: number): number => {
    const first = inside(j) * kShadowEdge;
    return before[first + inside(i - 1)]! + 2 * before[first + i]! + before[first + inside(i + 1)]!;
  };
  for (let j = 0; j < kShadowEdge; ++j) {
    for (let i = 0; i < kShadowEdge; ++i) field[j * kShadowEdge + i] = (row(i, j - 1) + 2 * row(i, j) + row(i, j + 1)) / 16;
  }
}
