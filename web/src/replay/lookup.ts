// SPDX-License-Identifier: Apache-2.0
// Where things are in a recording: the pose of a moment, and the geometry and the station in force then.
import { lastAt, type ChunkContent, type Timed } from "./chunk";
import type { ChunkCache } from "./chunk_cache";
import type { Recording } from "./recording";

export interface Placed<Value> extends Timed<Value> {
  readonly chunk: number;
}

const lists = {
  "/pose": (content: ChunkContent) => content.poses,
  "/geometry": (content: ChunkContent) => content.geometries,
  "/setup": (content: ChunkContent) => content.stations,
  "/change": (content: ChunkContent) => content.changes,
};
type Listed = keyof typeof lists;
type ValueOf<Wanted extends Listed> = ReturnType<(typeof lists)[Wanted]>[number]["value"];

export class Lookup {
  private readonly ends: Float64Array; // of the chunks, never falling: an event may be written after later steps

  constructor(
    private readonly recording: Recording,
    private readonly cache: ChunkCache,
  ) {
    let latest = 0;
    this.ends = Float64Array.from(recording.chunks, ({ end }) => (latest = Math.max(latest, end)));
  }

  /// Number of the first chunk that ends at this time or later; of the last one if none does.
  chunkAt(time: number): number {
    let [low, high] = [0, this.ends.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.ends[middle]! >= time) high = middle;
      else low = middle + 1;
    }
    return low;
  }

  /// The first pose after this time. @throws SourceError
  async poseAfter(time: number): Promise<Placed<Uint8Array> | undefined> {
    for (let chunk = this.chunkAt(time); chunk < this.recording.chunks.length; ++chunk) {
      if (!this.recording.chunks[chunk]!.topics.has("/pose")) continue;
      const found = (await this.cache.need(chunk)).poses.find((pose) => pose.time > time);
      if (found) return { ...found, chunk };
    }
    return undefined;
  }

  /// The last message of a topic at this time or before. @throws SourceError
  async last<Wanted extends Listed>(topic: Wanted, time: number): Promise<Placed<ValueOf<Wanted>> | undefined> {
    for (let chunk = this.chunkAt(time); chunk >= 0; --chunk) {
      const place = this.recording.chunks[chunk]!;
      if (place.begin > time || !place.topics.has(topic)) continue;
      const found = lastAt<ValueOf<Wanted>>(lists[topic](await this.cache.need(chunk)), time);
      if (found) return { ...found, chunk };
    }
    return undefined;
  }

  /// Whether all poses of these times are at hand.
  ready(from: number, to: number): boolean {
    return this.cache.has(this.chunkAt(from), this.chunkAt(to));
  }

  /// Makes them so. @throws SourceError
  load(from: number, to: number): Promise<void> {
    return this.cache.load(this.chunkAt(from), this.chunkAt(to));
  }

  /// Poses with from < time <= to, of the chunks that are at hand.
  poses(from: number, to: number): Timed<Uint8Array>[] {
    const found: Timed<Uint8Array>[] = [];
    for (let chunk = this.chunkAt(from); chunk <= this.chunkAt(to); ++chunk) {
      for (const pose of this.cache.get(chunk)?.poses ?? []) if (pose.time > from && pose.time <= to) found.push(pose);
    }
    return found;
  }

  /// Time of the next message of these topics, or before it a time at which to ask again; Infinity: there is none.
  next(topics: readonly Listed[], after: number): number {
    for (let chunk = this.chunkAt(after); chunk < this.recording.chunks.length; ++chunk) {
      const place = this.recording.chunks[chunk]!;
      const within = topics.filter((topic) => place.topics.has(topic));
      if (within.length === 0) continue;
      const known = this.cache.get(chunk);
      if (!known && place.begin > after) return place.begin;
      const times = within.flatMap((topic) => (known ? lists[topic](known).map(({ time }) => time) : [place.end])).filter((time) => time > after);
      if (times.length > 0) return Math.min(...times);
    }
    return Infinity;
  }
}
