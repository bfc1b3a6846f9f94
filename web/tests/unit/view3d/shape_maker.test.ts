// SPDX-License-Identifier: Apache-2.0
import { create, toBinary } from "@bufbuild/protobuf";
import { describe, expect, it, vi } from "vitest";
import { GeometrySchema, MeshSchema } from "../../../src/gen/phalanx/geometry_pb";
import { makeShapes, type ShapesWorker } from "../../../src/view3d/shape_maker";
import { shapesOf, type Shapes } from "../../../src/view3d/shapes";

const mesh = create(MeshSchema, { position: [0, 0, 0, 1, 0, 0, 0, 1, 0], index: [0, 1, 2] });
const geometry = create(GeometrySchema, { object: mesh, jointOpen: [0.5] });

class FakeWorker implements ShapesWorker {
  onmessage: ((event: { readonly data: Shapes }) => void) | null = null;
  onerror: ((event: unknown) => void) | null = null;
  onmessageerror: ((event: unknown) => void) | null = null;
  readonly postMessage = vi.fn();
  readonly terminate = vi.fn();
}

describe("makeShapes", () => {
  it("hands the bytes over, takes the shapes, and ends its thread", async () => {
    const worker = new FakeWorker();
    const bytes = new ArrayBuffer(8);
    const made = makeShapes(bytes, () => worker);
    expect(worker.postMessage).toHaveBeenCalledWith(bytes, [bytes]);
    expect(worker.terminate).not.toHaveBeenCalled();
    const shapes = shapesOf(geometry);
    worker.onmessage!({ data: shapes });
    expect(await made).toBe(shapes);
    expect(worker.terminate).toHaveBeenCalledOnce();
  });
  it("fails, and ends its thread, where the thread does", async () => {
    const worker = new FakeWorker();
    const made = makeShapes(new ArrayBuffer(8), () => worker);
    worker.onerror!(new Error("no such file"));
    await expect(made).rejects.toThrow("no such file");
    expect(worker.terminate).toHaveBeenCalledOnce();
  });
});

describe("the thread", () => {
  it("answers the bytes of a Geometry with its shapes, and keeps no copy", async () => {
    const said: [Shapes, { transfer: Transferable[] }][] = [];
    vi.stubGlobal("postMessage", (shapes: Shapes, options: { transfer: Transferable[] }) => void said.push([shapes, options]));
    await import("../../../src/view3d/shapes_worker");
    dispatchEvent(new MessageEvent("message", { data: toBinary(GeometrySchema, geometry).slice().buffer }));
    vi.unstubAllGlobals();
    expect(said.length).toBe(1);
    expect(said[0]![0]).toEqual(shapesOf(geometry));
    expect(said[0]![1].transfer.length).toBe(4);
  });
});
