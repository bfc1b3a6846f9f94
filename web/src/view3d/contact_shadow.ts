// SPDX-License-Identifier: Apache-2.0
// How dark the table is below hand and object: a coarse field over the table, darker the lower something is above it. It is computed by the
// processor, in a fraction of a millisecond, so that every quality has it.
import type { Capsule } from "./object_material";
import { kShadowEdge, texelOf, type Square } from "./underside";

const kObjectHeight = 0.035; // [m] in which the object's shadow falls to 1/e
const kFingerHeight = 0.045;
const kObjectDarkness = 0.62;
const kFingerDarkness = 0.34;

export class ContactShadow {
  readonly texels = new Uint8Array(kShadowEdge * kShadowEdge); // 255: black
  private square: Square = { x: 0, y: 0, edge: 1 };
  private height = 0; // of the table
  private readonly object = new Float32Array(kShadowEdge * kShadowEdge); // lightness that the object leaves, 0 .. 1
  private readonly light = new Float32Array(kShadowEdge * kShadowEdge);

  constructor() {
    this.object.fill(1);
  }

  /// @param lowest  point of the object above each texel of the square; null: there is no object
  lay(square: Square, height: number, lowest: Float32Array | null): void {
    this.square = square;
    this.height = height;
    for (let i = 0; i < this.object.length; ++i) {
      const above = Math.max(0, (lowest?.[i] ?? Infinity) - height);
      this.object[i] = 1 - kObjectDarkness * Math.exp(-above / kObjectHeight);
    }
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
    const [i, j] = [texelOf(x - this.square.x, this.square), texelOf(y - this.square.y, this.square)];
    return i < 0 || j < 0 || i >= kShadowEdge || j >= kShadowEdge ? 0 : this.texels[j * kShadowEdge + i]! / 255;
  }

  private castFinger({ from, to, radius }: Capsule): void {
    const { x, y, edge } = this.square;
    const texel = (along: number): number => texelOf(along, this.square);
    const above = Math.max(0, (from[2] + to[2]) / 2 - radius - this.height);
    const dark = kFingerDarkness * Math.exp(-above / kFingerHeight);
    if (dark < 0.01) return;
    const soft = radius + 0.5 * above; // half a shadow's width grows with the height
    const reach = 2.2 * soft;
    const step = edge / kShadowEdge;
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const square = Math.max(1e-12, dx * dx + dy * dy);
    const [i0, i1] = [texel(Math.min(from[0], to[0]) - reach - x), texel(Math.max(from[0], to[0]) + reach - x)];
    const [j0, j1] = [texel(Math.min(from[1], to[1]) - reach - y), texel(Math.max(from[1], to[1]) + reach - y)];
    for (let j = Math.max(0, j0); j <= Math.min(kShadowEdge - 1, j1); ++j) {
      for (let i = Math.max(0, i0); i <= Math.min(kShadowEdge - 1, i1); ++i) {
        const [px, py] = [x + (i + 0.5) * step - from[0], y + (j + 0.5) * step - from[1]];
        const share = Math.min(1, Math.max(0, (px * dx + py * dy) / square));
        const away = Math.hypot(px - share * dx, py - share * dy) / soft;
        this.light[j * kShadowEdge + i]! *= 1 - dark * Math.exp(-away * away);
      }
    }
  }
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
