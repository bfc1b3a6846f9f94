// SPDX-License-Identifier: Apache-2.0
// Surfaces as the renderer wants them: the hand's on 16 bones, be it a continuous skin or the rigid segments, and the object's.
import { Box3, BufferAttribute, BufferGeometry, Matrix4, Vector3 } from "three";
import { bindInverses } from "./poses";
import { kSegments } from "./segments";
import { kDetail } from "./skin_detail";
import { kInfluences, ownersOf, type BonedSurface, type SkinSurface, type Surface } from "./shapes";
import { centresOfRotation } from "./skinning";

export interface HandShape {
  readonly geometry: BufferGeometry; // with skinIndex, skinWeight, skinCentre and skinDetail
  readonly inverses: readonly Matrix4[]; // X_SB: bone matrix = X_WS X_SB
  readonly boxes: readonly Box3[]; // of each segment's part, in its frame S; empty: it has none
  readonly source: Uint32Array; // SkinSurface.source; empty: no skin
}

/// Null if there is none or its bind pose is not whole.
export function skinShape(skin: SkinSurface | null): HandShape | null {
  const inverses = skin && bindInverses(skin.bindPose);
  return skin && inverses && assemble(skin, inverses, skin.source, skin.detail);
}

export function segmentShape(segments: BonedSurface | null): HandShape | null {
  if (!segments) return null;
  const plain = new Float32Array((kDetail * segments.position.length) / 3);
  return assemble(segments, Array.from({ length: kSegments }, () => new Matrix4()), new Uint32Array(), plain);
}

export function objectShape(object: Surface | null): BufferGeometry | null {
  if (!object) return null;
  const geometry = geometryOf(object);
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
}

function geometryOf(surface: Surface): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(surface.position, 3));
  geometry.setAttribute("normal", new BufferAttribute(surface.normal, 3));
  geometry.setIndex(new BufferAttribute(surface.index, 1));
  return geometry;
}

function assemble(surface: BonedSurface, inverses: readonly Matrix4[], source: Uint32Array, detail: Float32Array): HandShape {
  const geometry = geometryOf(surface);
  geometry.setAttribute("skinIndex", new BufferAttribute(surface.bone, kInfluences));
  geometry.setAttribute("skinWeight", new BufferAttribute(surface.weight, kInfluences));
  geometry.setAttribute("skinCentre", new BufferAttribute(centresOfRotation(surface.position, surface.bone, surface.weight, inverses), 3));
  geometry.setAttribute("skinDetail", new BufferAttribute(detail, kDetail));
  return { geometry, inverses, boxes: boxesOf(geometry, surface, inverses), source };
}

/// Each vertex counts for the segment that has most of it.
function boxesOf(geometry: BufferGeometry, surface: BonedSurface, inverses: readonly Matrix4[]): Box3[] {
  const boxes = inverses.map(() => new Box3());
  const position = geometry.getAttribute("position");
  const point = new Vector3();
  ownersOf(surface).forEach((segment, i) => {
    boxes[segment]!.expandByPoint(point.fromBufferAttribute(position, i).applyMatrix4(inverses[segment]!));
  });
  return boxes;
}
