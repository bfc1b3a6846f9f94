// SPDX-License-Identifier: Apache-2.0
// Chunks are decompressed in another thread, so that neither view nor controls wait for it.
import type { ChunkContent, ChunkSurvey, Layout } from "./chunk";

/// The thread has failed: nothing more can be decoded.
export class DecoderError extends Error {}

export interface Decoder {
  /// @throws Error if the chunk is damaged or encrypted
  /// @throws DecoderError
  decode(bytes: Uint8Array): Promise<ChunkContent>;
  survey(bytes: Uint8Array): Promise<ChunkSurvey>;
  close(): void;
}

export interface Task {
  readonly id: number;
  readonly what: "decode" | "survey";
  readonly bytes: Uint8Array;
  readonly layout: Layout;
}

export interface Done {
  readonly id: number;
  readonly result?: ChunkContent | ChunkSurvey;
  readonly error?: string;
}

/// The part of a Worker that is used here.
export interface ChunkWorker {
  onmessage: ((event: { readonly data: Done }) => void) | null;
  onerror: ((event: unknown) => void) | null;
  postMessage(task: Task, transfer: ArrayBuffer[]): void;
  terminate(): void;
}

const ownThread = () => new Worker(new URL("./chunk_worker.ts", import.meta.url), { type: "module" }) as ChunkWorker;

interface Waiting {
  readonly done: (result: unknown) => void;
  readonly failed: (reason: Error) => void;
}

export function threadDecoder(layout: Layout, open: () => ChunkWorker = ownThread): Decoder {
  const worker = open();
  const waiting = new Map<number, Waiting>();
  let tasks = 0;
  worker.onmessage = ({ data: { id, result, error } }) => {
    const one = waiting.get(id);
    waiting.delete(id);
    if (result) one?.done(result);
    else one?.failed(new Error(error));
  };
  let broken = false;
  worker.onerror = () => {
    broken = true;
    for (const { failed } of waiting.values()) failed(new DecoderError());
    waiting.clear();
  };
  function give<Result>(what: Task["what"], bytes: Uint8Array): Promise<Result> {
    if (broken) return Promise.reject(new DecoderError());
    const id = ++tasks;
    const own = bytes.slice();
    return new Promise<Result>((done, failed) => {
      waiting.set(id, { done: done as (result: unknown) => void, failed });
      worker.postMessage({ id, what, bytes: own, layout }, [own.buffer]);
    });
  }
  return { decode: (bytes) => give("decode", bytes), survey: (bytes) => give("survey", bytes), close: () => worker.terminate() };
}
