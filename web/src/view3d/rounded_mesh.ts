// SPDX-License-Identifier: Apache-2.0
// A finer mesh over a coarse one, for a round outline: each triangle becomes four, and what is new is pulled onto the tangent planes of
// its edge's ends (Boubekeur and Alexa 2008, "Phong tessellation"; at an edge's middle their eq. 2 with alpha = 3/4).
export interface RoundedMesh {
  readonly position: Float32Array; // 3 a vertex; the coarse mesh's vertices come first, where they were
  readonly index: Uint32Array;
  readonly ends: Uint32Array; // 2 a vertex: the coarse vertices that it lies between; twice the same: it is that one
}

const kPull = 0.75;

/// @param normal  3 a vertex, unit
/// A watertight mesh stays one: the new vertex of an edge is shared by its triangles.
export function roundedMesh(position: ArrayLike<number>, normal: ArrayLike<number>, index: ArrayLike<number>): RoundedMesh {
  const vertices = Math.floor(position.length / 3);
  const ends: number[] = [];
  for (let i = 0; i < vertices; ++i) ends.push(i, i);
  const places: number[] = Array.from(position).slice(0, 3 * vertices);
  const middles = new Map<number, number>();
  const middle = (a: number, b: number): number => {
    const key = Math.min(a, b) * vertices + Math.max(a, b);
    const known = middles.get(key);
    if (known !== undefined) return known;
    const made = places.length / 3;
    places.push(...middleOf(position, normal, a, b));
    ends.push(a, b);
    middles.set(key, made);
    return made;
  };
  const fine: number[] = [];
  for (let i = 0; i + 2 < index.length; i += 3) {
    const a = index[i]!, b = index[i + 1]!, c = index[i + 2]!;
    const ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.push(a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca);
  }
  return { position: Float32Array.from(places), index: Uint32Array.from(fine), ends: Uint32Array.from(ends) };
}

/// m + pull ((projections of m onto both tangent planes)/2 - m)
function middleOf(position: ArrayLike<number>, normal: ArrayLike<number>, a: number, b: number): [number, number, number] {
  const point: [number, number, number] = [0, 0, 0];
  for (let k = 0; k < 3; ++k) point[k] = (position[3 * a + k]! + position[3 * b + k]!) / 2;
  const moved: [number, number, number] = [...point];
  for (const end of [a, b]) {
    let height = 0;
    for (let k = 0; k < 3; ++k) height += (point[k]! - position[3 * end + k]!) * normal[3 * end + k]!;
    for (let k = 0; k < 3; ++k) moved[k] = moved[k]! - (kPull / 2) * height * normal[3 * end + k]!;
  }
  return moved;
}
