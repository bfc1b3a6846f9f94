// SPDX-License-Identifier: Apache-2.0
// The station's shapes as arrays that the renderer takes as they are. Knows no renderer: this is what a worker does, since a large
// mesh takes seconds.
import type { Geometry, Mesh, Skin } from "../gen/phalanx/geometry_pb";
import { creaseNormals, type ShadedMesh } from "./crease_normals";
import { displayMesh } from "./display_mesh";
import { nailsOn } from "./nails";
import { poseMatrices } from "./poses";
import { roundedMesh } from "./rounded_mesh";
import { kSegments } from "./segments";
import { boundHand, kDetail, skinDetail } from "./skin_detail";
import { undersideOf, type Underside } from "./underside";

export const kInfluences = 4;
const kRoundBelow = 6000; // triangles; a finer skin looks round without rounding
const kSegmentCrease = (50 * Math.PI) / 180;
export const kObjectCrease = (38 * Math.PI) / 180;

export interface Surface {
  readonly position: Float32Array; // 3 a vertex
  readonly normal: Float32Array; // 3 a vertex, unit
  readonly index: Uint32Array; // 3 a triangle
}

/// A surface on 16 bones.
export interface BonedSurface extends Surface {
  readonly bone: Uint8Array; // 4 a vertex
  readonly weight: Float32Array; // 4 a vertex, sum 1
}

export interface SkinSurface extends BonedSurface {
  readonly bindPose: readonly number[]; // X_BS, 16 x 7
  readonly source: Uint32Array; // of its first vertices: which vertex of the station's skin each is; those behind lie between, or on nails
  readonly detail: Float32Array; // kDetail a vertex
}

/// The part of a Geometry that the page keeps.
export interface Shapes {
  readonly left: boolean;
  readonly segmentName: readonly string[];
  readonly jointName: readonly string[];
  readonly jointMin: readonly number[]; // [rad], 20
  readonly jointMax: readonly number[];
  readonly jointOpen: readonly number[];
  readonly skin: SkinSurface | null; // null: this hand has none, or it does not fit together
  readonly segments: BonedSurface | null; // each on its own bone, in its frame S
  readonly object: Surface | null; // in W, that the hand touches; null: an empty scene
  readonly objectDisplay: Surface | null; // its smooth mesh; null: `object` looks round as it is
  readonly underside: Underside | null; // of the object; null: there is none
}

export function shapesOf(geometry: Geometry): Shapes {
  const { left, segmentName, jointName, jointMin, jointMax, jointOpen } = geometry;
  return {
    left, segmentName, jointName, jointMin, jointMax, jointOpen,
    skin: skinSurface(geometry.skin), segments: segmentSurface(geometry), ...objectSurfaces(geometry.object),
  };
}

/// The buffers that are transferred from one thread to another, not copied.
export function buffersOf(shapes: Shapes): ArrayBufferLike[] {
  return [shapes.skin, shapes.segments, shapes.object, shapes.objectDisplay, shapes.underside].flatMap((surface) =>
    Object.values(surface ?? {}).flatMap((array: unknown) => (ArrayBuffer.isView(array) ? [array.buffer] : [])),
  );
}

/// The continuous skin.
function skinSurface(skin: Skin | undefined): SkinSurface | null {
  const mesh = skin?.mesh;
  if (!skin || !mesh || mesh.index.length === 0) return null;
  const vertices = mesh.position.length / 3;
  if (skin.segment.length !== kInfluences * vertices || skin.weight.length !== kInfluences * vertices) return null;
  if (skin.segment.some((segment) => segment >= kSegments)) return null;
  const coarse = creaseNormals(mesh.position, mesh.index, Math.PI);
  const influences = Array.from(coarse.source, (vertex) => influencesOf(skin, vertex));
  if (coarse.index.length >= 3 * kRoundBelow) return assembleSkin(coarse, influences, skin, coarse.source);
  const fine = roundedMesh(coarse.position, coarse.normal, coarse.index);
  const shaded = creaseNormals(fine.position, fine.index, Math.PI);
  const blended = Array.from(shaded.source, (vertex) => {
    const a = fine.ends[2 * vertex]!, b = fine.ends[2 * vertex + 1]!;
    return a === b ? influences[a]! : blend(influences[a]!, influences[b]!);
  });
  const source = shaded.source.filter((vertex) => vertex < influences.length).map((vertex) => coarse.source[vertex]!);
  return assembleSkin(shaded, blended, skin, source);
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

function assembleSkin({ position, normal, index }: ShadedMesh, influences: readonly Influences[], skin: Skin, source: Uint32Array): SkinSurface {
  const bone = new Uint8Array(kInfluences * influences.length);
  const weight = new Float32Array(bone.length);
  influences.forEach((list, vertex) => {
    list.forEach(([segment, share], k) => {
      bone[kInfluences * vertex + k] = segment;
      weight[kInfluences * vertex + k] = share;
    });
  });
  return withDetail({ position, normal, index, bone, weight, source, bindPose: skin.bindPose, detail: new Float32Array(kDetail * influences.length) });
}

/// With what its places look like, and with nails. As it is where the bind pose is not whole.
function withDetail(skin: SkinSurface): SkinSurface {
  const frames = poseMatrices(skin.bindPose);
  if (!frames) return skin;
  const owner = ownersOf(skin);
  const hand = boundHand(frames, skin.position, owner);
  const nails = nailsOn(hand, skin, owner);
  const vertices = owner.length;
  const bone = new Uint8Array(kInfluences * nails.segment.length);
  const weight = new Float32Array(bone.length);
  nails.segment.forEach((segment, vertex) => {
    bone[kInfluences * vertex] = segment;
    weight[kInfluences * vertex] = 1;
  });
  return {
    ...skin,
    position: Float32Array.from([...skin.position, ...nails.position]),
    normal: Float32Array.from([...skin.normal, ...nails.normal]),
    index: Uint32Array.from([...skin.index, ...nails.index.map((vertex) => vertex + vertices)]),
    bone: Uint8Array.from([...skin.bone, ...bone]),
    weight: Float32Array.from([...skin.weight, ...weight]),
    detail: Float32Array.from([...skinDetail(hand, skin.position, skin.normal, owner), ...nails.detail]),
  };
}

/// Of each vertex: the segment that has most of it.
export function ownersOf({ bone, weight }: Pick<BonedSurface, "bone" | "weight">): Uint8Array {
  return Uint8Array.from({ length: bone.length / kInfluences }, (_, vertex) => {
    let most = kInfluences * vertex;
    for (let k = most + 1; k < kInfluences * (vertex + 1); ++k) if (weight[k]! > weight[most]!) most = k;
    return bone[most]!;
  });
}

/// The rigid segments, each on its own bone: those meant for display, else those that the search sees. Null: there are none.
function segmentSurface(geometry: Geometry): BonedSurface | null {
  const meshes: readonly Mesh[] = geometry.display.length === kSegments ? geometry.display : geometry.segment;
  if (meshes.length !== kSegments) return null;
  const shaded = meshes.map((mesh) => creaseNormals(mesh.position, mesh.index, kSegmentCrease));
  const vertices = shaded.reduce((sum, mesh) => sum + mesh.source.length, 0);
  if (vertices === 0) return null;
  const bone = new Uint8Array(kInfluences * vertices);
  const weight = new Float32Array(bone.length);
  let at = 0;
  shaded.forEach((mesh, segment) => {
    for (let i = 0; i < mesh.source.length; ++i, at += kInfluences) {
      bone[at] = segment;
      weight[at] = 1;
    }
  });
  return { ...merged(shaded, vertices), bone, weight };
}

/// The object with smooth normals and creases, as the hand touches it and for display.
function objectSurfaces(mesh: Mesh | undefined): Pick<Shapes, "object" | "objectDisplay" | "underside"> {
  if (!mesh || mesh.index.length === 0) return { object: null, objectDisplay: null, underside: null };
  const shaded = creaseNormals(mesh.position, mesh.index, kObjectCrease);
  const { position, normal, index } = shaded;
  return { object: { position, normal, index }, objectDisplay: displayMesh(shaded), underside: undersideOf(position, index) };
}

function merged(parts: readonly ShadedMesh[], vertices: number): Surface {
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
  return { position, normal, index };
}
