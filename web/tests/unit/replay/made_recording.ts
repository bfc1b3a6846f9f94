// SPDX-License-Identifier: Apache-2.0
// Recordings made for a test: their bytes, a source that counts and may fail, and a decoder in the same thread.
import { create, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import { McapWriter } from "@mcap/core";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { ChangeSchema, EventSchema, GapSchema, SetupSchema, StepSchema } from "../../../src/gen/phalanx/recording_pb";
import { TickSchema, type Tick } from "../../../src/gen/phalanx/tick_pb";
import { decodeChunk, surveyChunk, type Layout } from "../../../src/replay/chunk";
import type { Decoder } from "../../../src/replay/decoder";
import { openRecording, type Recording } from "../../../src/replay/recording";
import { SourceError, type Source } from "../../../src/replay/source";

export const kBegin = 1_795_828_153_000_000_000n; // UTC [ns]
export const kRate = 60; // poses a second

interface Message {
  readonly topic: string;
  readonly time: number; // [s]
  readonly data: Uint8Array;
}

export const pose = (time: number, tick: MessageInitShape<typeof TickSchema> = {}): Message => ({
  topic: "/pose", time, data: toBinary(TickSchema, create(TickSchema, { time: 1000 + time, factor: 1, ...tick })),
});
export const setup = (time: number, value: MessageInitShape<typeof SetupSchema> = {}): Message => ({ topic: "/setup", time, data: toBinary(SetupSchema, create(SetupSchema, value)) });
export const change = (time: number, value: MessageInitShape<typeof ChangeSchema>): Message => ({ topic: "/change", time, data: toBinary(ChangeSchema, create(ChangeSchema, value)) });
export const geometry = (time: number, revision: number, rateHz = kRate): Message => ({
  topic: "/geometry", time, data: toBinary(GeometrySchema, create(GeometrySchema, { revision, rateHz, object: { position: [1, 2, 3] } })),
});
export const event = (time: number, code: string, text: string, who = ""): Message => ({ topic: "/event", time, data: toBinary(EventSchema, create(EventSchema, { code, text, who })) });
export const gap = (time: number, firstTick: bigint, lastTick: bigint, why: string): Message => ({
  topic: "/gap", time, data: toBinary(GapSchema, create(GapSchema, { firstTick, lastTick, why })),
});

/// The force on the index finger's tip at a time: another one for each pose.
export const forceAt = (time: number) => 1 + Math.sin(time) * 0.5;

/// Poses from one time up to another, with the index finger pressing; numbered from `first` on.
export function poses(from: number, to: number, first = 1): Message[] {
  const made: Message[] = [];
  for (let i = 0; from + i / kRate < to; ++i) {
    const time = from + i / kRate;
    made.push(pose(time, { tick: BigInt(first + i), contact: [{ segment: 5, touching: true, force: forceAt(time), normal: [0, 0, 1] }] }));
  }
  return made;
}

const kSchemas: Readonly<Record<string, string>> = {
  "/setup": SetupSchema.typeName, "/change": ChangeSchema.typeName, "/step": StepSchema.typeName, "/pose": TickSchema.typeName,
  "/event": EventSchema.typeName, "/gap": GapSchema.typeName, "/geometry": GeometrySchema.typeName,
};

const kWriting = {
  topics: Object.keys(kSchemas) as readonly string[],
  chunkSize: 900,
  schemas: kSchemas,
  encoding: "protobuf",
  index: {} as { readonly useMessageIndex?: boolean; readonly useStatistics?: boolean },
};

export async function bytesOf(messages: readonly Message[], options: Partial<typeof kWriting> = {}): Promise<Uint8Array> {
  const { topics, chunkSize, schemas, encoding, index } = { ...kWriting, ...options };
  const parts: Uint8Array[] = [];
  let size = 0;
  const writable = {
    position: () => BigInt(size),
    write: (part: Uint8Array) => {
      parts.push(part.slice());
      size += part.length;
      return Promise.resolve();
    },
  };
  const writer = new McapWriter({ writable, chunkSize, ...index });
  await writer.start({ profile: "", library: "phalanx" });
  const ids = new Map<string, number>();
  for (const topic of topics) {
    const schemaId = await writer.registerSchema({ name: schemas[topic] ?? "", encoding: "protobuf", data: new Uint8Array() });
    ids.set(topic, await writer.registerChannel({ topic, schemaId, messageEncoding: encoding, metadata: new Map() }));
  }
  await writer.addMetadata({ name: "phalanx", metadata: new Map([["version", "0.1.0"]]) });
  let sequence = 0;
  for (const { topic, time, data } of messages) {
    const logTime = kBegin + BigInt(Math.round(time * 1e9));
    await writer.addMessage({ channelId: ids.get(topic)!, sequence: ++sequence, logTime, publishTime: logTime, data });
  }
  await writer.end();
  const bytes = new Uint8Array(size);
  parts.reduce((at, part) => {
    bytes.set(part, at);
    return at + part.length;
  }, 0);
  return bytes;
}

export interface MadeSource extends Source {
  reads: number;
  gone: boolean; // answers nothing any more
  held: Promise<void> | undefined; // answers only then
}

export function sourceOf(bytes: Uint8Array): MadeSource {
  const made: MadeSource = {
    name: "made.mcap",
    reads: 0,
    gone: false,
    held: undefined,
    size: () => Promise.resolve(BigInt(bytes.length)),
    read: async (offset, length) => {
      await made.held;
      if (made.gone) throw new SourceError("gone", "made.mcap");
      ++made.reads;
      return bytes.slice(Number(offset), Number(offset + length));
    },
  };
  return made;
}

export function plainDecoder(layout: Layout): Decoder {
  return {
    decode: async (bytes) => decodeChunk(bytes, layout),
    survey: async (bytes) => surveyChunk(bytes, layout),
    close: () => {},
  };
}

export async function madeRecording(messages: readonly Message[]): Promise<{ recording: Recording; source: MadeSource; decoder: Decoder }> {
  const source = sourceOf(await bytesOf(messages));
  const recording = await openRecording(source);
  source.reads = 0;
  return { recording, source, decoder: plainDecoder(recording.layout) };
}

export const forceOf = (tick: Tick | undefined) => tick?.contact[0]?.force ?? NaN;
