// SPDX-License-Identifier: Apache-2.0
// The underside of an object over the table: what its shadow is made of. Knows no renderer: a worker makes it, since a large mesh takes a
// while.

export const kShadowEdge = 64; // texels
const kLeastEdge = 0.5; // of the square [m]
const kRoom = 1.6; // of the square, in lengths of what stands on it: for hands and for the shadow
const kMostCuts = 48; // of a triangle's side

/// A square of the table in W [m].
export interface Square {
  readonly x: number; // of its lower corner
  readonly y: number;
  readonly edge: number;
}

export interface Underside {
  readonly square: Square;
  readonly lowest: Float32Array; // point above each texel, in W [m]; Infinity: there is none
}

type Place = Readonly<Record<"x" | "y", number>>;

/// A square around what casts a shadow.
export function squareAround({ min, max }: { readonly min: Place; readonly max: Place }): Square {
  const edge = Math.max(kLeastEdge, kRoom * Math.max(max.x - min.x, max.y - min.y));
  return { x: (min.x + max.x - edge) / 2, y: (min.y + max.y - edge) / 2, edge };
}

export const texelOf = (along: number, { edge }: Square): number => Math.floor((along / edge) * kShadowEdge);

/// The lowest of points of the triangles, at most a texel apart. @param position  3 numbers a vertex
export function undersideOf(position: ArrayLike<number>, index: ArrayLike<number>): Underside {
  const square = squareAround(extentOf(position));
  const lowest = new Float32Array(kShadowEdge * kShadowEdge).fill(Infinity);
  const drop = (x: number, y: number, z: number): void => {
    const [i, j] = [texelOf(x - square.x, square), texelOf(y - square.y, square)];
    if (i < 0 || j < 0 || i >= kShadowEdge || j >= kShadowEdge) return;
    const at = j * kShadowEdge + i;
    lowest[at] = Math.min(lowest[at]!, z);
  };
  for (let t = 0; t + 2 < index.length; t += 3) {
    const a = 3 * index[t]!;
    const side = (corner: number): number[] => [0, 1, 2].map((k) => position[3 * index[t + corner]! + k]! - position[a + k]!);
    const [u, v] = [side(1), side(2)];
    const span = Math.hypot(u[0]!, u[1]!) + Math.hypot(v[0]!, v[1]!);
    const cuts = Math.min(kMostCuts, Math.max(1, Math.ceil((span / square.edge) * kShadowEdge)));
    for (let p = 0; p <= cuts; ++p) {
      for (let q = 0; p + q <= cuts; ++q) {
        const at = (k: number): number => position[a + k]! + (p * u[k]! + q * v[k]!) / cuts;
        drop(at(0), at(1), at(2));
      }
    }
  }
  return { square, lowest };
}

function extentOf(position: ArrayLike<number>): { readonly min: Place; readonly max: Place } {
  const [min, max] = [{ x: Infinity, y: Infinity }, { x: -Infinity, y: -Infinity }];
  for (let i = 0; i + 2 < position.length; i += 3) {
    const [x, y] = [position[i]!, position[i + 1]!];
    min.x = Math.min(min.x, x);
    min.y = Math.min(min.y, y);
    max.x = Math.max(max.x, x);
    max.y = Math.max(max.y, y);
  }
  return { min, max };
}
