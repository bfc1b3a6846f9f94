// SPDX-License-Identifier: Apache-2.0
// A recording as its index describes it: its length, and which chunk holds which times and topics.
import { McapIndexedReader } from "@mcap/core";
import { decompressHandlers, kLargestChunk, type Layout, type Topic } from "./chunk";
import type { Source } from "./source";

/// noMcap: another kind of file; noIndex: the file has no end or is damaged; noPoses: it is no recording of this program; empty: no step.
export type FileTrouble = "noMcap" | "noIndex" | "noPoses" | "empty";

export class FileError extends Error {
  constructor(
    readonly trouble: FileTrouble,
    detail = "",
  ) {
    super(`${trouble} ${detail}`);
  }
}

/// A chunk's place in the file and in time.
export interface ChunkPlace {
  readonly offset: number;
  readonly length: number; // [bytes]
  readonly begin: number; // of its first message [s]
  readonly end: number; // of its last
  readonly topics: ReadonlySet<string>;
}

export interface Recording {
  readonly source: Source;
  readonly layout: Layout;
  readonly chunks: readonly ChunkPlace[]; // in the file's order
  readonly seconds: number; // length
  readonly bytes: number;
  readonly version: string; // of the program that wrote it; empty: not stated
  count(topic: Topic): number; // of messages
}

const kMagic = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a]; // "\x89MCAP0\r\n"
const kMagicLength = BigInt(kMagic.length);
const isMagic = (bytes: Uint8Array) => kMagic.every((byte, i) => bytes[i] === byte);

async function readIndex(source: Source): Promise<McapIndexedReader> {
  const size = await source.size();
  if (size < kMagicLength || !isMagic(await source.read(0n, kMagicLength))) throw new FileError("noMcap");
  if (size < 2n * kMagicLength || !isMagic(await source.read(size - kMagicLength, kMagicLength))) throw new FileError("noIndex");
  let failed: unknown; // of the source, which is not the file's fault
  const read = (offset: bigint, length: bigint) =>
    source.read(offset, length).catch((reason: unknown) => {
      failed = reason;
      throw reason;
    });
  try {
    return await McapIndexedReader.Initialize({ readable: { size: () => Promise.resolve(size), read }, decompressHandlers });
  } catch (reason) {
    if (failed) throw failed;
    throw new FileError("noIndex", String(reason));
  }
}

/// As in src/record/recording/topics.h.
const schemas: Readonly<Record<Topic, string>> = {
  "/pose": "phalanx.wire.Tick",
  "/geometry": "phalanx.wire.Geometry",
  "/event": "phalanx.wire.Event",
  "/gap": "phalanx.wire.Gap",
  "/setup": "phalanx.wire.Setup",
  "/change": "phalanx.wire.Change",
};

/// The channels of this program. Other programs use the same topics with other messages.
function topicsOf({ channelsById, schemasById }: McapIndexedReader): Map<number, Topic> {
  const found = new Map<number, Topic>();
  for (const { id, topic, schemaId, messageEncoding } of channelsById.values()) {
    const schema = schemas[topic as Topic] as string | undefined;
    if (schema !== undefined && messageEncoding === "protobuf" && schemasById.get(schemaId)?.name === schema) found.set(id, topic as Topic);
  }
  return found;
}

async function versionOf(reader: McapIndexedReader): Promise<string> {
  for await (const { metadata } of reader.readMetadata({ name: "phalanx" })) return metadata.get("version") ?? "";
  return "";
}

/// @throws FileError, SourceError
export async function openRecording(source: Source): Promise<Recording> {
  const reader = await readIndex(source);
  const channels = [...reader.channelsById.values()];
  const topics = topicsOf(reader);
  const { statistics } = reader;
  if (![...topics.values()].includes("/pose")) throw new FileError("noPoses");
  if (!statistics) throw new FileError("noIndex", "no statistics");
  const messages = (id: number) => Number(statistics.channelMessageCounts.get(id) ?? 0n);
  const count = (wanted: Topic) => [...topics].reduce((sum, [id, topic]) => sum + (topic === wanted ? messages(id) : 0), 0);
  if (count("/pose") === 0) throw new FileError("empty");
  const begin = statistics.messageStartTime;
  const since = (time: bigint) => Number(time - begin) / 1e9;
  const bytes = await source.size();
  const all = new Set(topics.values());
  /// A chunk without an index of its messages may hold every topic.
  const topicsIn = (ids: readonly number[]) => (ids.length === 0 ? all : new Set(ids.flatMap((id) => topics.get(id) ?? [])));
  for (const { chunkStartOffset, chunkLength } of reader.chunkIndexes) {
    if (chunkLength > kLargestChunk || chunkStartOffset + chunkLength > bytes) throw new FileError("noIndex", "a chunk outside the file");
  }
  const chunks = [...reader.chunkIndexes]
    .sort((a, b) => Number(a.chunkStartOffset - b.chunkStartOffset))
    .map((chunk) => ({
      offset: Number(chunk.chunkStartOffset),
      length: Number(chunk.chunkLength),
      begin: since(chunk.messageStartTime),
      end: since(chunk.messageEndTime),
      topics: topicsIn([...chunk.messageIndexOffsets.keys()]),
    }));
  return {
    source,
    layout: { begin, topics, channels },
    chunks,
    seconds: since(statistics.messageEndTime),
    bytes: Number(bytes),
    version: await versionOf(reader).catch(() => ""),
    count,
  };
}
