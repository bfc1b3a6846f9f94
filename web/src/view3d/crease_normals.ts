// SPDX-License-Identifier: Apache-2.0
// Vertex normals that are smooth over round parts and break at edges.

export interface ShadedMesh {
  readonly position: Float32Array; // 3 a vertex
  readonly normal: Float32Array; // 3 a vertex, unit
  readonly index: Uint32Array; // 3 a triangle
  readonly source: Uint32Array; // of each vertex: which vertex of the input it is, or is a copy of
}

/// Around each vertex the triangles are gathered into groups: two that share an edge are in one group unless their
/// normals differ by more than `crease` [rad]. Each group gets the mean of its normals, weighted by the angle at
/// the vertex, and its own copy of the vertex. Triangles without area and with an index out of range are left
/// out. crease >= pi: no vertex is copied.
export function creaseNormals(positions: ArrayLike<number>, indices: ArrayLike<number>, crease: number): ShadedMesh {
  const position = Float32Array.from(positions);
  const vertices = Math.floor(position.length / 3);
  const faces = usableFaces(position, indices, vertices);
  const around = facesAround(faces.index, vertices);
  const cosCrease = crease >= Math.PI ? -2 : Math.cos(crease);
  const group = new Int32Array(64); // grows with the largest valence
  return shade(position, faces, around, cosCrease, group);
}

interface Faces {
  readonly index: Uint32Array;
  readonly normal: Float32Array;
}

function usableFaces(position: Float32Array, indices: ArrayLike<number>, vertices: number): Faces {
  const index = new Uint32Array(indices.length - (indices.length % 3));
  const normal = new Float32Array(index.length);
  let kept = 0;
  for (let i = 0; i + 2 < indices.length; i += 3) {
    const a = indices[i]!, b = indices[i + 1]!, c = indices[i + 2]!;
    if (!(a < vertices && b < vertices && c < vertices)) continue;
    const ux = position[3 * b]! - position[3 * a]!, uy = position[3 * b + 1]! - position[3 * a + 1]!;
    const uz = position[3 * b + 2]! - position[3 * a + 2]!;
    const vx = position[3 * c]! - position[3 * a]!, vy = position[3 * c + 1]! - position[3 * a + 1]!;
    const vz = position[3 * c + 2]! - position[3 * a + 2]!;
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    const length = Math.hypot(x, y, z);
    if (!(length > 0) || !Number.isFinite(length)) continue;
    index[kept] = a;
    index[kept + 1] = b;
    index[kept + 2] = c;
    normal[kept] = x / length;
    normal[kept + 1] = y / length;
    normal[kept + 2] = z / length;
    kept += 3;
  }
  return { index: index.subarray(0, kept), normal: normal.subarray(0, kept) };
}

interface Around {
  readonly first: Uint32Array; // vertices + 1
  readonly corner: Uint32Array; // positions in `index`
}

function facesAround(index: Uint32Array, vertices: number): Around {
  const first = new Uint32Array(vertices + 1);
  for (const vertex of index) ++first[vertex + 1]!;
  for (let i = 0; i < vertices; ++i) first[i + 1]! += first[i]!;
  const fill = first.slice(0, vertices);
  const corner = new Uint32Array(index.length);
  for (let i = 0; i < index.length; ++i) corner[fill[index[i]!]!++] = i;
  return { first, corner };
}

function shade(position: Float32Array, faces: Faces, around: Around, cosCrease: number, scratch: Int32Array): ShadedMesh {
  const vertices = around.first.length - 1;
  const outIndex = new Uint32Array(faces.index.length);
  const source: number[] = [];
  const normals: number[] = [];
  let group = scratch;
  for (let vertex = 0; vertex < vertices; ++vertex) {
    const begin = around.first[vertex]!;
    const count = around.first[vertex + 1]! - begin;
    if (count > group.length) group = new Int32Array(2 * count);
    gather(faces, around.corner, begin, count, cosCrease, group);
    for (let root = 0; root < count; ++root) {
      if (find(group, root) !== root) continue;
      let x = 0, y = 0, z = 0;
      for (let i = root; i < count; ++i) {
        if (find(group, i) !== root) continue;
        const corner = around.corner[begin + i]!;
        const face = corner - (corner % 3);
        const weight = angleAt(position, faces.index, corner);
        x += weight * faces.normal[face]!;
        y += weight * faces.normal[face + 1]!;
        z += weight * faces.normal[face + 2]!;
        outIndex[corner] = source.length;
      }
      const length = Math.hypot(x, y, z);
      if (length > 1e-12) normals.push(x / length, y / length, z / length);
      else normals.push(0, 0, 1); // faces that cancel out: any direction will do
      source.push(vertex);
    }
  }
  const outPosition = new Float32Array(3 * source.length);
  for (let i = 0; i < source.length; ++i) {
    const from = 3 * source[i]!;
    outPosition.set(position.subarray(from, from + 3), 3 * i);
  }
  return { position: outPosition, normal: Float32Array.from(normals), index: outIndex, source: Uint32Array.from(source) };
}

/// group[i]: towards the smallest corner of the group that corner i is in.
function gather(faces: Faces, corners: Uint32Array, begin: number, count: number, cosCrease: number, group: Int32Array): void {
  for (let i = 0; i < count; ++i) group[i] = cosCrease < -1 ? 0 : i;
  if (cosCrease < -1) return;
  for (let i = 0; i < count; ++i) {
    for (let j = i + 1; j < count; ++j) {
      const a = corners[begin + i]!, b = corners[begin + j]!;
      if (!shareEdge(faces.index, a, b)) continue;
      const p = a - (a % 3), q = b - (b % 3);
      const cosine = faces.normal[p]! * faces.normal[q]! + faces.normal[p + 1]! * faces.normal[q + 1]! + faces.normal[p + 2]! * faces.normal[q + 2]!;
      if (cosine < cosCrease) continue;
      const x = find(group, i), y = find(group, j);
      group[Math.max(x, y)] = Math.min(x, y);
    }
  }
}

function find(group: Int32Array, i: number): number {
  while (group[i] !== i) i = group[i]!;
  return i;
}

/// Two corners at one vertex: do their triangles have another vertex in common?
function shareEdge(index: Uint32Array, a: number, b: number): boolean {
  const a1 = index[next(a)]!, a2 = index[next(next(a))]!;
  const b1 = index[next(b)]!, b2 = index[next(next(b))]!;
  return a1 === b1 || a1 === b2 || a2 === b1 || a2 === b2;
}

function next(corner: number): number {
  return corner % 3 === 2 ? corner - 2 : corner + 1;
}

function angleAt(position: Float32Array, index: Uint32Array, corner: number): number {
  const o = 3 * index[corner]!, a = 3 * index[next(corner)]!, b = 3 * index[next(next(corner))]!;
  const ux = position[a]! - position[o]!, uy = position[a + 1]! - position[o + 1]!, uz = position[a + 2]! - position[o + 2]!;
  const vx = position[b]! - position[o]!, vy = position[b + 1]! - position[o + 1]!, vz = position[b + 2]! - position[o + 2]!;
  const cosine = (ux * vx + uy * vy + uz * vz) / (Math.hypot(ux, uy, uz) * Math.hypot(vx, vy, vz));
  return Math.acos(Math.min(1, Math.max(-1, cosine)));
}
