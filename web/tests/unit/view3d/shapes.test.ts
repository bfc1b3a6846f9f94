// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { GeometrySchema, MeshSchema, SkinSchema } from "../../../src/gen/phalanx/geometry_pb";
import { kSegments } from "../../../src/view3d/segments";
import { buffersOf, shapesOf } from "../../../src/view3d/shapes";

/// A tetrahedron with its vertices on two bones, more and more on the second.
const mesh = create(MeshSchema, { position: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], index: [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3] });
const skin = create(SkinSchema, {
  mesh,
  segment: Array.from({ length: 4 }, () => [3, 4, 0, 0]).flat(),
  weight: [1, 0, 0, 0, 0.75, 0.25, 0, 0, 0.5, 0.5, 0, 0, 0, 1, 0, 0],
  bindPose: Array.from({ length: kSegments }, () => [0, 0, 0, 0, 0, 0, 1]).flat(),
});
const geometry = create(GeometrySchema, { left: true, skin, segment: Array.from({ length: kSegments }, () => mesh), object: mesh, jointMin: [1], jointMax: [2], jointOpen: [1.5] });

describe("shapesOf", () => {
  it("keeps each vertex's weights at a sum of 1, also where it adds vertices", () => {
    const { weight, position } = shapesOf(geometry).skin!;
    expect(position.length / 3).toBe(4 + 6); // and one for each edge
    for (let i = 0; i < weight.length; i += 4) expect(weight[i]! + weight[i + 1]! + weight[i + 2]! + weight[i + 3]!).toBeCloseTo(1, 6);
  });
  it("says which of the station's vertices are which, also where one is in no triangle", () => {
    const spare = create(SkinSchema, {
      mesh: create(MeshSchema, { position: [9, 9, 9, ...mesh.position], index: mesh.index.map((i) => i + 1) }),
      segment: [0, 0, 0, 0, ...skin.segment], weight: [1, 0, 0, 0, ...skin.weight], bindPose: skin.bindPose,
    });
    const { source, position } = shapesOf(create(GeometrySchema, { skin: spare })).skin!;
    expect([...source]).toEqual([1, 2, 3, 4]);
    source.forEach((vertex, i) => expect([...position.subarray(3 * i, 3 * i + 3)]).toEqual(mesh.position.slice(3 * (vertex - 1), 3 * vertex)));
  });
  it("refuses a skin that does not fit together", () => {
    for (const spoil of ["segment", "weight"] as const) {
      expect(shapesOf(create(GeometrySchema, { skin: { ...skin, [spoil]: skin[spoil].slice(1) } })).skin).toBeNull();
    }
    expect(shapesOf(create(GeometrySchema, { skin: { ...skin, segment: skin.segment.map(() => 16) } })).skin).toBeNull();
  });
  it("puts each segment on its own bone, and has none where one is missing", () => {
    const { bone, weight } = shapesOf(geometry).segments!;
    expect(bone[0]).toBe(0);
    expect(bone[bone.length - 4]).toBe(kSegments - 1);
    expect(weight[0]).toBe(1);
    expect(shapesOf(create(GeometrySchema, { segment: [mesh] })).segments).toBeNull();
  });
  it("makes nothing of an empty scene, and passes on what is no shape", () => {
    const { object, left, jointMin, jointMax, jointOpen } = shapesOf(create(GeometrySchema, { ...geometry, object: create(MeshSchema) }));
    expect(object).toBeNull();
    expect({ left, jointMin, jointMax, jointOpen }).toEqual({ left: true, jointMin: [1], jointMax: [2], jointOpen: [1.5] });
  });
});

describe("buffersOf", () => {
  it("are those of all arrays, each once: 7 of the skin, 5 of the segments, 3 of the object and one of its underside; none of a display mesh for what is flat", () => {
    const buffers = buffersOf(shapesOf(geometry));
    expect(buffers.length).toBe(7 + 5 + 3 + 1);
    expect(new Set(buffers).size).toBe(buffers.length);
  });
});
