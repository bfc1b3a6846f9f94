// SPDX-License-Identifier: Apache-2.0
import type { ChunkPlace, Recording } from "./recording";
import type { Source } from "./source";

const kLargestRead = 1 << 20; // [bytes]

/// Chunks that follow each other in the file, up to about a megabyte. @param wanted  numbers of chunks, rising
export function runsOf(chunks: readonly ChunkPlace[], wanted: readonly number[]): number[][] {
  const runs: number[][] = [];
  for (const i of wanted) {
    const run = runs.at(-1);
    const { offset, length } = chunks[i]!;
    const joins = run !== undefined && run.at(-1) === i - 1 && offset + length - chunks[run[0]!]!.offset <= kLargestRead;
    if (joins) run.push(i);
    else runs.push([i]);
  }
  return runs;
}

/// Reads a run of chunks at once. @returns each chunk's bytes
/// @throws SourceError
export async function readRun(source: Source, chunks: Recording["chunks"], run: readonly number[]): Promise<Uint8Array[]> {
  const first = chunks[run[0]!]!;
  const last = chunks[run.at(-1)!]!;
  const bytes = await source.read(BigInt(first.offset), BigInt(last.offset + last.length - first.offset));
  return run.map((i) => {
    const { offset, length } = chunks[i]!;
    return bytes.subarray(offset - first.offset, offset - first.offset + length);
  });
}
