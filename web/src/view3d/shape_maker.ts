// SPDX-License-Identifier: Apache-2.0
import type { Shapes } from "./shapes";

/// The part of a Worker that is used here.
export interface ShapesWorker {
  onmessage: ((event: { readonly data: Shapes }) => void) | null;
  onerror: ((event: unknown) => void) | null;
  onmessageerror: ((event: unknown) => void) | null;
  postMessage(bytes: ArrayBuffer, transfer: ArrayBuffer[]): void;
  terminate(): void;
}

const ownThread = () => new Worker(new URL("./shapes_worker.ts", import.meta.url), { type: "module" }) as ShapesWorker;

/// Makes shapes of the bytes of a Geometry in another thread, which ends with it.
/// @throws what is wrong with the bytes, or with the thread
export function makeShapes(bytes: ArrayBuffer, open: () => ShapesWorker = ownThread): Promise<Shapes> {
  const worker = open();
  return new Promise<Shapes>((resolve, reject) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = worker.onmessageerror = reject;
    worker.postMessage(bytes, [bytes]);
  }).finally(() => worker.terminate());
}
