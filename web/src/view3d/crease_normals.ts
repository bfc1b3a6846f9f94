// SPDX-License-Identifier: Apache-2.0
// Vertex normals that are smooth over round parts and break at edges.

export interface ShadedMesh {
  readonly position: Float32Array; // 3 a vertex
  readonly normal: Float32Array; // 3 a vertex, unit
  readonly index: Uint32Array; // 3 a triangle
  readonly source: Uint32Array; // of each vertex: which vertex of the input it is, or is a copy of
}

/// At an edge of more triangles than this all of them are in one group: pair by pair they would take for ever.
const kMostAtEdge = 64;

/// Around each vertex the triangles are gathered into groups: two that share an edge are in one group unless their
/// normals differ by more than `crease` [rad]. Each group gets the mean of its normals, weighted by the angle at
/// the vertex, and its own copy of the vertex. Triangles without area and with an index out of range are left
/// out. crease >= pi: no vertex is copied. Takes time in proportion to the triangles, however many meet in one place.
export function creaseNormals(positions: ArrayLike<number>, indices: ArrayLike<number>, crease: number): ShadedMesh {
  const position = Float32Array.from(positions);
  const vertices = Math.floor(position.length / 3);
  const faces = usableFaces(position, indices, vertices);
  const around = facesAround(faces.index, vertices);
  return shade(position, faces, around, new Groups(faces, vertices, crease));
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

function shade(position: Float32Array, faces: Faces, around: Around, groups: Groups): ShadedMesh {
  const outIndex = new Uint32Array(faces.index.length);
  const source = new Uint32Array(faces.index.length); // at most one copy a corner
  const normal = new Float32Array(3 * faces.index.length);
  let made = 0;
  for (let vertex = 0; vertex + 1 < around.first.length; ++vertex) {
    const corners = around.corner.subarray(around.first[vertex]!, around.first[vertex + 1]!);
    const firstCopy = made;
    groups.gather(corners);
    const sum = new Float64Array(3 * corners.length);
    corners.forEach((corner, i) => {
      const root = groups.rootOf(i); // not after i: its copy is made already
      if (root === i) source[made++] = vertex;
      const copy = root === i ? made - 1 : outIndex[corners[root]!]!;
      outIndex[corner] = copy;
      const at = 3 * (copy - firstCopy);
      const face = corner - (corner % 3);
      const weight = angleAt(position, faces.index, corner);
      for (let k = 0; k < 3; ++k) sum[at + k] = sum[at + k]! + weight * faces.normal[face + k]!;
    });
    for (let copy = firstCopy; copy < made; ++copy) {
      const at = 3 * (copy - firstCopy);
      const length = Math.hypot(sum[at]!, sum[at + 1]!, sum[at + 2]!);
      for (let k = 0; k < 3; ++k) normal[3 * copy + k] = length > 1e-12 ? sum[at + k]! / length : k === 2 ? 1 : 0; // none: any will do
    }
  }
  const outPosition = new Float32Array(3 * made);
  for (let i = 0; i < made; ++i) {
    const from = 3 * source[i]!;
    outPosition.set(position.subarray(from, from + 3), 3 * i);
  }
  return { position: outPosition, normal: normal.slice(0, 3 * made), index: outIndex, source: source.slice(0, made) };
}

/// Which corners at one vertex belong together. Two triangles there share an edge if they have another vertex in common, so corners
/// are met by their neighbours.
class Groups {
  private parent = new Int32Array(64); // of corner i: towards the smallest of its group; grows with the largest valence
  private before = new Int32Array(128); // of side 2 i or 2 i + 1 of corner i: the last one before it with its neighbour; -1: none
  private readonly last: Int32Array; // of each neighbour: the last side that has it; -1: none
  private readonly sides: Int32Array; // of each neighbour: how many sides have it
  private readonly cosCrease: number;
  private readonly whole: boolean;

  constructor(private readonly faces: Faces, vertices: number, crease: number) {
    this.last = new Int32Array(vertices).fill(-1);
    this.sides = new Int32Array(vertices);
    this.cosCrease = Math.cos(crease);
    this.whole = crease >= Math.PI;
  }

  gather(corners: Uint32Array): void {
    if (corners.length > this.parent.length) {
      this.parent = new Int32Array(2 * corners.length);
      this.before = new Int32Array(4 * corners.length);
    }
    for (let i = 0; i < corners.length; ++i) this.parent[i] = this.whole ? 0 : i;
    if (this.whole) return;
    for (let side = 0; side < 2 * corners.length; ++side) ++this.sides[this.neighbour(corners, side)]!;
    for (let side = 0; side < 2 * corners.length; ++side) this.meet(corners, side);
    for (let side = 0; side < 2 * corners.length; ++side) {
      const neighbour = this.neighbour(corners, side);
      this.last[neighbour] = -1;
      this.sides[neighbour] = 0;
    }
  }

  /// The smallest corner of the group that corner i is in.
  rootOf(i: number): number {
    const { parent } = this;
    while (parent[i] !== i) i = parent[i] = parent[parent[i]!]!; // every path is halved on the way
    return i;
  }

  /// With the sides before it that have the same neighbour.
  private meet(corners: Uint32Array, side: number): void {
    const neighbour = this.neighbour(corners, side);
    const newest = this.last[neighbour]!;
    if (this.sides[neighbour]! > kMostAtEdge) {
      if (newest >= 0) this.unite(side >> 1, newest >> 1);
    } else {
      for (let other = newest; other >= 0; other = this.before[other]!) {
        if (this.smooth(corners[side >> 1]!, corners[other >> 1]!)) this.unite(side >> 1, other >> 1);
      }
    }
    this.before[side] = newest;
    this.last[neighbour] = side;
  }

  private neighbour(corners: Uint32Array, side: number): number {
    const one = next(corners[side >> 1]!);
    return this.faces.index[side % 2 === 0 ? one : next(one)]!;
  }

  private smooth(a: number, b: number): boolean {
    const { normal } = this.faces;
    const p = a - (a % 3), q = b - (b % 3);
    return normal[p]! * normal[q]! + normal[p + 1]! * normal[q + 1]! + normal[p + 2]! * normal[q + 2]! >= this.cosCrease;
  }

  private unite(i: number, j: number): void {
    const x = this.rootOf(i), y = this.rootOf(j);
    this.parent[Math.max(x, y)] = Math.min(x, y);
  }
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
