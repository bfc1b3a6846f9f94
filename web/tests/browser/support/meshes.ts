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

/// A box as binary STL, its edges of the file's units, around the origin.
/// @param left  faces to leave out: the surface is open there
export function box(edges: Point, left = 0): Buffer {
  const at = (corner: number): Point => {
    const [x, y, z] = corners[corner]!;
    return [(x - 0.5) * edges[0], (y - 0.5) * edges[1], (z - 0.5) * edges[2]];
  };
  return stl(faces.slice(2 * left).map((face) => face.map(at)));
}

export const cube = (size: number, left = 0) => box([size, size, size], left);

/// The station's answer to the mesh of a cup of 85 x 95 mm that stands along y in its file.
export function cupAnswer(name: string): object {
  const profile: readonly (readonly [radius: number, height: number])[] = [
    [0, 0], [24, 0], [29, 2], [34, 20], [38, 45], [41, 75], [42.5, 95], [39.5, 95], [38, 75], [35, 45], [31, 22], [26, 6], [0, 5],
  ];
  const round = 72;
  const position = profile.flatMap(([radius, height]) =>
    Array.from({ length: round }, (_, i) => (2 * Math.PI * i) / round).flatMap((angle) => [radius * Math.sin(angle), height, radius * Math.cos(angle)]),
  );
  const triangle: number[] = [];
  for (let ring = 0; ring + 1 < profile.length; ++ring) {
    for (let i = 0; i < round; ++i) {
      const [a, b] = [ring * round + i, ring * round + ((i + 1) % round)];
      triangle.push(a, b, a + round, b, b + round, a + round);
    }
  }
  const triangles = triangle.length / 3;
  const report = {
    verdict: "usable: a closed solid", triangles, vertices: position.length / 3, extent_m: [0.085, 0.095, 0.085], closed: true, sheets: 0, volume_m3: 6.1e-5,
    findings: [{ kind: "duplicate_vertices", found: 12, meaning: "equal positions became one vertex" }],
  };
  return { ok: true, error: "", report, file: `/var/phalanx/uploads/${name}`, preview: { position_um: position.map((at) => Math.round(1000 * at)), triangle } };
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
