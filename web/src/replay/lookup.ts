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
const kMostUnreadable = 50; // chunks, about 10 s: behind them a lookup goes no farther back
const kGapAhead = 0.25; // [s]: a gap whose end is farther away is seen by the age of the shown pose

type Listed = keyof typeof lists;
type ValueOf<Wanted extends Listed> = ReturnType<(typeof lists)[Wanted]>[number]["value"];

export class Lookup {
  private readonly ends: Float64Array; // latest end of each chunk and those before: a message may be written after later ones
  private readonly begins: Float64Array; // earliest begin of each chunk and those behind

  constructor(
    private readonly recording: Recording,
    private readonly cache: ChunkCache,
  ) {
    let latest = 0;
    this.ends = Float64Array.from(recording.chunks, ({ end }) => (latest = Math.max(latest, end)));
    let earliest = Infinity;
    this.begins = Float64Array.from([...recording.chunks].reverse(), ({ begin }) => (earliest = Math.min(earliest, begin))).reverse();
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

  /// Number of the last chunk that may hold a message of this time; not before chunkAt(time).
  private lastChunkAt(time: number): number {
    let chunk = this.chunkAt(time);
    while (chunk + 1 < this.begins.length && this.begins[chunk + 1]! <= time) ++chunk;
    return chunk;
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
    let newest: Placed<ValueOf<Wanted>> | undefined;
    let unreadable = 0;
    for (let chunk = this.lastChunkAt(time); chunk >= 0; --chunk) {
      if (newest && this.ends[chunk]! < newest.time) break;
      const place = this.recording.chunks[chunk]!;
      if (place.begin > time || !place.topics.has(topic)) continue;
      const found = lastAt<ValueOf<Wanted>>(lists[topic](await this.cache.need(chunk)), time);
      if (this.cache.isDamaged(chunk) && ++unreadable >= kMostUnreadable) break;
      if (found && !(newest && newest.time >= found.time)) newest = { ...found, chunk };
    }
    return newest;
  }

  /// Whether all poses of these times are at hand.
  ready(from: number, to: number): boolean {
    return this.cache.has(this.chunkAt(from), this.lastChunkAt(to));
  }

  /// Makes them so. @throws SourceError
  load(from: number, to: number): Promise<void> {
    return this.cache.load(this.chunkAt(from), this.lastChunkAt(to));
  }

  /// Poses with from < time <= to, of the chunks that are at hand.
  poses(from: number, to: number): Timed<Uint8Array>[] {
    const found: Timed<Uint8Array>[] = [];
    const last = this.lastChunkAt(to);
    for (let chunk = this.chunkAt(from); chunk <= last; ++chunk) {
      for (const pose of this.cache.get(chunk)?.poses ?? []) if (pose.time > from && pose.time <= to) found.push(pose);
    }
    return found;
  }

  /// Whether steps are known to be missing at this time. @param rate  steps a second
  missing(time: number, rate: number): boolean {
    if (!(rate > 0)) return false;
    const last = this.chunkAt(time + kGapAhead);
    for (let chunk = this.chunkAt(time); chunk <= last; ++chunk) {
      const gaps = this.cache.peek(chunk)?.gaps ?? [];
      if (gaps.some((gap) => time < gap.time && time >= gap.time - gap.value.steps / rate)) return true;
    }
    return false;
  }

  /// Time of the next message of these topics, or before it a time at which to ask again; Infinity: there is none.
  next(topics: readonly Listed[], after: number): number {
    let soonest = Infinity;
    for (let chunk = this.chunkAt(after); chunk < this.recording.chunks.length && this.begins[chunk]! < soonest; ++chunk) {
      const place = this.recording.chunks[chunk]!;
      const within = topics.filter((topic) => place.topics.has(topic));
      if (within.length === 0) continue;
      const known = this.cache.get(chunk);
      const unknown = place.begin > after ? place.begin : place.end;
      const times = within.flatMap((topic) => (known ? lists[topic](known).map(({ time }) => time) : [unknown]));
      soonest = Math.min(soonest, ...times.filter((time) => time > after));
    }
    return soonest;
  }
}
