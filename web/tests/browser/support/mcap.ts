// SPDX-License-Identifier: Apache-2.0
// MCAP files, read by an independent reader.
import { readFileSync } from "node:fs";
import { McapIndexedReader, type McapTypes } from "@mcap/core";
import { decompress } from "fzstd";

export const decompressHandlers: McapTypes.DecompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };

/// A reader by the index at the file's end.
export function byIndexOf(file: string): Promise<McapIndexedReader> {
  const bytes = readFileSync(file);
  const readable = {
    size: () => Promise.resolve(BigInt(bytes.length)),
    read: (offset: bigint, size: bigint) => Promise.resolve(new Uint8Array(bytes.subarray(Number(offset), Number(offset + size)))),
  };
  return McapIndexedReader.Initialize({ readable, decompressHandlers });
}
