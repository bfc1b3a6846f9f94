// SPDX-License-Identifier: Apache-2.0
// A thread of its own: the bytes of one Geometry in, its Shapes out. Nothing of it holds up Stop.
import { fromBinary } from "@bufbuild/protobuf";
import { GeometrySchema } from "../gen/phalanx/geometry_pb";
import { buffersOf, shapesOf } from "./shapes";

addEventListener("message", ({ data }: MessageEvent<ArrayBuffer>) => {
  const shapes = shapesOf(fromBinary(GeometrySchema, new Uint8Array(data)));
  postMessage(shapes, { transfer: buffersOf(shapes) as Transferable[] });
});
