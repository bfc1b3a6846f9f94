// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { ChunkCache } from "../../../src/replay/chunk_cache";
import { decodeChunk } from "../../../src/replay/chunk";
import { DecoderError } from "../../../src/replay/decoder";
import { bytesOf, madeRecording, plainDecoder, poses, sourceOf } from "./made_recording";
import { openRecording } from "../../../src/replay/recording";

describe("the cache of chunks", () => {
  it("reads neighbours at once, and each of them once", async () => {
    const { recording, source, decoder } = await madeRecording(poses(0, 3));
    const cache = new ChunkCache(recording, decoder);
    await Promise.all([cache.load(0, 5), cache.load(2, 8)]);
    expect(source.reads).toBe(2); // 0 to 5, then 6 to 8
    await cache.load(0, 8);
    expect(source.reads).toBe(2);
    expect(cache.has(0, 8)).toBe(true);
    expect(cache.has(0, 9)).toBe(false);
  });

  it("holds no more than its bound, and drops what was used longest ago", async () => {
    const { recording, decoder } = await madeRecording(poses(0, 3));
    const cache = new ChunkCache(recording, decoder, 4);
    await cache.load(0, 3);
    cache.get(0);
    await cache.load(4, 4);
    expect(cache.size).toBe(4);
    expect(cache.get(0)).toBeDefined();
    expect(cache.get(1)).toBe(undefined);
    await cache.load(0, recording.chunks.length);
    expect(cache.size).toBe(4);
  });

  it("has nothing of a damaged chunk, and goes on with the others", async () => {
    const bytes = await bytesOf(poses(0, 3));
    const { chunks } = await openRecording(sourceOf(bytes));
    bytes[chunks[2]!.offset + chunks[2]!.length - 5]! ^= 0xff;
    const recording = await openRecording(sourceOf(bytes));
    const cache = new ChunkCache(recording, plainDecoder(recording.layout));
    await cache.load(0, 4);
    expect(cache.damaged).toBe(1);
    expect(cache.get(2)!.poses).toEqual([]);
    expect(cache.get(3)!.poses.length).toBeGreaterThan(0);
  });

  it("takes a torn chunk, and bytes that are no chunk, for damaged, not for empty", async () => {
    const { recording, source } = await madeRecording(poses(0, 1));
    const { offset, length } = recording.chunks[1]!;
    const bytes = await source.read(BigInt(offset), BigInt(length));
    expect(decodeChunk(bytes, recording.layout).poses.length).toBeGreaterThan(0);
    for (const part of [bytes.subarray(0, length - 1), bytes.subarray(0, 20), new Uint8Array(length), new Uint8Array()]) {
      expect(() => decodeChunk(part, recording.layout), `${part.length} of ${length} bytes`).toThrow();
    }
  });

  it("is bounded in bytes, too, but keeps what playing needs", async () => {
    const { recording, decoder } = await madeRecording(poses(0, 5));
    expect(recording.chunks.length).toBeGreaterThan(20);
    const cache = new ChunkCache(recording, decoder, 600, 1);
    await cache.load(0, recording.chunks.length);
    expect(cache.size).toBe(16);
  });

  it("does not call chunks damaged that a failed thread did not decode", async () => {
    const { recording } = await madeRecording(poses(0, 1));
    const cache = new ChunkCache(recording, { decode: () => Promise.reject(new DecoderError()), survey: () => Promise.reject(new DecoderError()), close: () => {} });
    await expect(cache.load(0, 1)).rejects.toThrow(DecoderError);
    expect(cache.damaged).toBe(0);
  });

  it("tries again what the source refused", async () => {
    const { recording, source, decoder } = await madeRecording(poses(0, 3));
    const cache = new ChunkCache(recording, decoder);
    source.gone = true;
    await expect(cache.load(0, 2)).rejects.toThrow();
    source.gone = false;
    await cache.load(0, 2);
    expect(cache.has(0, 2)).toBe(true);
  });
});
