// SPDX-License-Identifier: Apache-2.0
// The decoded chunks around the displayed moment. The oldest ones are dropped.
import type { ChunkContent } from "./chunk";
import { readRun, runsOf } from "./chunk_reader";
import { DecoderError, type Decoder } from "./decoder";
import type { Recording } from "./recording";

const kKept = 600; // chunks; one has 0.2 s, its poses take 20 kB
const kKeptBytes = 1 << 28; // a geometry may take megabytes
const kLeastKept = 16; // chunks, however large: playing needs the next ones

const unreadable: ChunkContent = { poses: [], geometries: [], events: [], gaps: [], stations: [], changes: [] };

function bytesOf({ poses, geometries }: ChunkContent): number {
  return [...poses, ...geometries].reduce((sum, { value }) => sum + value.length, 0);
}

export class ChunkCache {
  private readonly kept = new Map<number, ChunkContent>(); // the least recently used first
  private bytes = 0; // of those
  private readonly loading = new Map<number, Promise<void>>();
  private readonly broken = new Set<number>();

  constructor(
    private readonly recording: Recording,
    private readonly decoder: Decoder,
    private readonly most = kKept,
    private readonly mostBytes = kKeptBytes,
  ) {}

  /// Chunks that could not be decoded.
  get damaged(): number {
    return this.broken.size;
  }

  isDamaged(chunk: number): boolean {
    return this.broken.has(chunk);
  }

  get size(): number {
    return this.kept.size;
  }

  get(chunk: number): ChunkContent | undefined {
    const content = this.kept.get(chunk);
    if (content) {
      this.kept.delete(chunk);
      this.kept.set(chunk, content);
    }
    return content;
  }

  /// Likewise, but does not count as a use.
  peek(chunk: number): ChunkContent | undefined {
    return this.kept.get(chunk);
  }

  /// @param from, to  chunks, both included
  has(from: number, to: number): boolean {
    for (let i = from; i <= to; ++i) if (!this.kept.has(i)) return false;
    return true;
  }

  /// Loads what is missing of these. A damaged chunk is empty.
  /// @throws SourceError
  async load(from: number, to: number): Promise<void> {
    const last = Math.min(to, this.recording.chunks.length - 1);
    const missing: number[] = [];
    const awaited = new Set<Promise<void>>();
    for (let i = Math.max(from, 0); i <= last; ++i) {
      const busy = this.loading.get(i);
      if (busy) awaited.add(busy);
      else if (!this.get(i)) missing.push(i);
    }
    for (const run of runsOf(this.recording.chunks, missing)) {
      const read = this.read(run).finally(() => run.forEach((i) => this.loading.delete(i)));
      run.forEach((i) => this.loading.set(i, read));
      awaited.add(read);
    }
    await Promise.all(awaited);
  }

  async need(chunk: number): Promise<ChunkContent> {
    await this.load(chunk, chunk);
    return this.get(chunk) ?? unreadable;
  }

  private async read(run: readonly number[]): Promise<void> {
    const bytes = await readRun(this.recording.source, this.recording.chunks, run);
    await Promise.all(bytes.map(async (part, i) => this.keep(run[i]!, await this.decode(run[i]!, part))));
  }

  private async decode(chunk: number, bytes: Uint8Array): Promise<ChunkContent> {
    try {
      return await this.decoder.decode(bytes);
    } catch (reason) {
      if (reason instanceof DecoderError) throw reason;
      this.broken.add(chunk);
      return unreadable;
    }
  }

  private keep(chunk: number, content: ChunkContent): void {
    this.kept.set(chunk, content);
    this.bytes += bytesOf(content);
    for (const [oldest, dropped] of this.kept) {
      const large = this.bytes > this.mostBytes && this.kept.size > kLeastKept;
      if (this.kept.size <= this.most && !large) break;
      this.kept.delete(oldest);
      this.bytes -= bytesOf(dropped);
    }
  }
}
