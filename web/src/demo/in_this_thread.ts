// SPDX-License-Identifier: Apache-2.0
// A page that was opened from disk may start no thread of its own: chunks are read and shapes are made in its only one.
import { fromBinary } from "@bufbuild/protobuf";
import { GeometrySchema } from "../gen/phalanx/geometry_pb";
import { decodeChunk, surveyChunk, type Layout } from "../replay/chunk";
import type { Decoder } from "../replay/decoder";
import type { Workshop } from "../replay/replay_view";
import { shapesOf } from "../view3d/shapes";

/// Between two chunks the page is drawn.
const later = <Result>(make: () => Result): Promise<Result> => new Promise((done, failed) => setTimeout(() => {
  try {
    done(make());
  } catch (reason) {
    failed(reason as Error);
  }
}));

const decoder = (layout: Layout): Decoder => ({
  decode: (bytes) => later(() => decodeChunk(bytes, layout)),
  survey: (bytes) => later(() => surveyChunk(bytes, layout)),
  close: () => {},
});

export const inThisThread: Workshop = {
  decoder,
  shapes: (bytes) => later(() => shapesOf(fromBinary(GeometrySchema, new Uint8Array(bytes)))),
};
