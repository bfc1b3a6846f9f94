// SPDX-License-Identifier: Apache-2.0
// The hand's surface as the renderer wants it: one mesh on 16 bones, be it a continuous skin or the rigid segments.
import { Box3, BufferAttribute, BufferGeometry, Matrix4, Vector3 } from "three";
import type { Geometry, Mesh, Skin } from "../gen/phalanx/geometry_pb";
import { creaseNormals } from "./crease_normals";
import type { ShadedMesh } from "./crease_normals";
import { bindInverses, kSegments } from "./poses";
import { roundedMesh } from "./rounded_mesh";

const kInfluences = 4;
const kRoundBelow = 6000; // triangles; a finer skin is round by itself
const kSegmentCrease = (50 * Math.PI) / 180;

export interface HandShape {
  readonly geometry: BufferGeometry; // with skinIndex and skinWeight
  readonly inverses: readonly Matrix4[]; // X_SB: bone matrix = X_WS X_SB
  readonly boxes: readonly Box3[]; // of each segment's part, in its frame S; empty: it has none
}

/// The continuous skin, or null if there is none or it does not fit together.
export function skinShape(skin: Skin | undefined): HandShape | null {
  const mesh = skin?.mesh;
  if (!skin || !mesh || mesh.index.length === 0) return null;
  const vertices = mesh.position.length / 3;
  const inverses = bindInverses(skin.bindPose);
  if (!inverses || skin.segment.length !== kInfluences * vertices || skin.weight.length !== kInfluences * vertices) return null;
  if (skin.segment.some((segment) => segment >= kSegments)) return null;
  const coarse = creaseNormals(mesh.position, mesh.index, Math.PI);
  const influences = Array.from(coarse.source, (vertex) => influencesOf(skin, vertex));
  if (coarse.index.length >= 3 * kRoundBelow) return assembleSkin(coarse, influences, inverses);
  const fine = roundedMesh(coarse.position, coarse.normal, coarse.index);
  const shaded = creaseNormals(fine.position, fine.index, Math.PI);
  const blended = Array.from(shaded.source, (vertex) => {
    const a = fine.ends[2 * vertex]!, b = fine.ends[2 * vertex + 1]!;
    return a === b ? influences[a]! : blend(influences[a]!, influences[b]!);
  });
  return assembleSkin(shaded, blended, inverses);
}

type Influences = readonly (readonly [segment: number, weight: number])[];

function influencesOf(skin: Skin, vertex: number): Influences {
  const first = kInfluences * vertex;
  return Array.from({ length: kInfluences }, (_, k) => [skin.segment[first + k]!, skin.weight[first + k]!] as const);
}

/// Half of each; of more than four the heaviest four, to a sum of 1.
function blend(a: Influences, b: Influences): Influences {
  const sum = new Map<number, number>();
  for (const [segment, weight] of [...a, ...b]) sum.set(segment, (sum.get(segment) ?? 0) + weight / 2);
  const heaviest = [...sum].sort((x, y) => y[1] - x[1]).slice(0, kInfluences);
  const total = heaviest.reduce((all, [, weight]) => all + weight, 0);
  return heaviest.map(([segment, weight]) => [segment, weight / total] as const);
}

function assembleSkin(shaded: ShadedMesh, influences: readonly Influences[], inverses: readonly Matrix4[]): HandShape {
  const index = new Uint8Array(kInfluences * influences.length);
  const weight = new Float32Array(index.length);
  influences.forEach((list, vertex) => {
    list.forEach(([segment, share], k) => {
      index[kInfluences * vertex + k] = segment;
      weight[kInfluences * vertex + k] = share;
    });
  });
  return assemble([shaded], index, weight, inverses);
}

/// The rigid segments, each on its own bone: those meant for display, else those that the search sees. Null: there are none.
export function segmentShape(geometry: Geometry): HandShape | null {
  const meshes: readonly Mesh[] = geometry.display.length === kSegments ? geometry.display : geometry.segment;
  if (meshes.length !== kSegments) return null;
  const shaded = meshes.map((mesh) => creaseNormals(mesh.position, mesh.index, kSegmentCrease));
  const vertices = shaded.reduce((sum, mesh) => sum + mesh.source.length, 0);
  if (vertices === 0) return null;
  const index = new Uint8Array(kInfluences * vertices);
  const weight = new Float32Array(index.length);
  let at = 0;
  shaded.forEach((mesh, segment) => {
    for (let i = 0; i < mesh.source.length; ++i, at += kInfluences) {
      index[at] = segment;
      weight[at] = 1;
    }
  });
  return assemble(shaded, index, weight, Array.from({ length: kSegments }, () => new Matrix4()));
}

/// The object with smooth normals and creases, in W. Null: an empty scene.
export function objectShape(mesh: Mesh | undefined): BufferGeometry | null {
  if (!mesh || mesh.index.length === 0) return null;
  const kObjectCrease = (38 * Math.PI) / 180;
  const geometry = merged([creaseNormals(mesh.position, mesh.index, kObjectCrease)]);
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
}

function assemble(parts: readonly ShadedMesh[], index: Uint8Array, weight: Float32Array, inverses: readonly Matrix4[]): HandShape {
  const geometry = merged(parts);
  geometry.setAttribute("skinIndex", new BufferAttribute(index, kInfluences));
  geometry.setAttribute("skinWeight", new BufferAttribute(weight, kInfluences));
  return { geometry, inverses, boxes: boxesOf(geometry, index, weight, inverses) };
}

function merged(parts: readonly ShadedMesh[]): BufferGeometry {
  const vertices = parts.reduce((sum, part) => sum + part.source.length, 0);
  const corners = parts.reduce((sum, part) => sum + part.index.length, 0);
  const position = new Float32Array(3 * vertices);
  const normal = new Float32Array(3 * vertices);
  const index = new Uint32Array(corners);
  let vertex = 0;
  let corner = 0;
  for (const part of parts) {
    position.set(part.position, 3 * vertex);
    normal.set(part.normal, 3 * vertex);
    for (const i of part.index) index[corner++] = i + vertex;
    vertex += part.source.length;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(position, 3));
  geometry.setAttribute("normal", new BufferAttribute(normal, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

/// Each vertex counts for the segment that has most of it.
function boxesOf(geometry: BufferGeometry, index: Uint8Array, weight: Float32Array, inverses: readonly Matrix4[]): Box3[] {
  const boxes = inverses.map(() => new Box3());
  const position = geometry.getAttribute("position");
  const point = new Vector3();
  for (let i = 0; i < position.count; ++i) {
    let most = kInfluences * i;
    for (let k = most + 1; k < kInfluences * (i + 1); ++k) if (weight[k]! > weight[most]!) most = k;
    const segment = index[most]!;
    boxes[segment]!.expandByPoint(point.fromBufferAttribute(position, i).applyMatrix4(inverses[segment]!));
  }
  return boxes;
}
