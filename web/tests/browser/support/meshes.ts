// SPDX-License-Identifier: Apache-2.0
// Meshes to upload, good and broken.

type Point = readonly [number, number, number];

const corners: readonly Point[] = Array.from({ length: 8 }, (_, i) => [i & 1, (i >> 1) & 1, i >> 2] as const);
/// Two triangles a face, counter-clockwise from outside.
const faces: readonly (readonly [number, number, number])[] = [
  [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
];

function stl(triangles: readonly (readonly Point[])[]): Buffer {
  const out = Buffer.alloc(84 + 50 * triangles.length);
  out.writeUInt32LE(triangles.length, 80);
  triangles.forEach((points, i) => points.forEach((point, corner) => point.forEach((value, axis) => out.writeFloatLE(value, 84 + 50 * i + 12 + 12 * corner + 4 * axis))));
  return out;
}

/// A cube as binary STL, its edges `size` of the file's units long, around the origin.
/// @param left  faces to leave out: the surface is open there
export function cube(size: number, left = 0): Buffer {
  const at = (corner: number): Point => {
    const [x, y, z] = corners[corner]!;
    return [(x - 0.5) * size, (y - 0.5) * size, (z - 0.5) * size];
  };
  return stl(faces.slice(2 * left).map((face) => face.map(at)));
}

/// Bytes of a seeded generator: no mesh at all.
export function noise(bytes: number, seed: number): Buffer {
  let state = seed >>> 0;
  return Buffer.from(
    Array.from({ length: bytes }, () => {
      state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
      return state >>> 24;
    }),
  );
}

export const asFile = (name: string, buffer: Buffer) => ({ name, mimeType: "model/stl", buffer });
