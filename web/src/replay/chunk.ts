// SPDX-License-Identifier: Apache-2.0
// The content of one chunk of a recording. Times are seconds since the recording's begin.
import { fromBinary } from "@bufbuild/protobuf";
import { McapRecordBuilder, McapStreamReader, type McapTypes } from "@mcap/core";
import { decompress } from "fzstd";
import { EventSchema, GapSchema } from "../gen/phalanx/recording_pb";
import { TickSchema } from "../gen/phalanx/tick_pb";
import { digitForces, kDigits } from "../state/channels";
import { changeFacts, rateOf, stationFacts, type ChangeFacts, type StationFacts } from "./station_facts";

export type Topic = "/pose" | "/geometry" | "/event" | "/gap" | "/setup" | "/change";

/// What is needed to read a chunk by itself.
export interface Layout {
  readonly begin: bigint; // of the recording, UTC [ns]
  readonly topics: ReadonlyMap<number, Topic>; // by channel, of those that this program wrote
  readonly channels: readonly McapTypes.TypedMcapRecords["Channel"][];
}

export interface Timed<Value> {
  readonly time: number;
  readonly value: Value;
}

/// The last one at this time or before. @param list  in the order of time
export function lastAt<Value>(list: readonly Timed<Value>[], time: number): Timed<Value> | undefined {
  let found: Timed<Value> | undefined;
  for (const one of list) if (one.time <= time) found = one;
  return found;
}

export interface EventFacts {
  readonly code: string;
  readonly who: string;
  readonly text: string;
}

export interface GapFacts {
  readonly steps: number;
  readonly why: string;
}

export interface ChunkContent {
  readonly poses: readonly Timed<Uint8Array>[]; // bytes of a Tick
  readonly geometries: readonly Timed<Uint8Array>[]; // bytes of a Geometry
  readonly events: readonly Timed<EventFacts>[];
  readonly gaps: readonly Timed<GapFacts>[];
  readonly stations: readonly Timed<StationFacts>[];
  readonly changes: readonly Timed<ChangeFacts>[];
}

/// The content without poses and meshes, and the force on each digit.
export interface ChunkSurvey extends Pick<ChunkContent, "events" | "gaps" | "stations"> {
  readonly rates: readonly Timed<number>[]; // steps a second, from these times on
  readonly forces: Float64Array; // kSurveyRow numbers for each pose: its time, then the force on each digit [N]
}
export const kSurveyRow = 1 + kDigits;

const kChunkRecord = 6; // the first byte of a chunk's record
export const kLargestChunk = 1 << 28; // [bytes], as stored and as decompressed: a damaged length may be anything

function decompressed(bytes: Uint8Array, size: bigint): Uint8Array {
  if (size > kLargestChunk) throw new Error(`a chunk of ${size} bytes`);
  return decompress(bytes, new Uint8Array(Number(size)));
}

export const decompressHandlers: McapTypes.DecompressHandlers = { zstd: decompressed };

const secondsSince = (begin: bigint, time: bigint) => Number(time - begin) / 1e9;

/// Channel records stand at the file's beginning, and its reader wants them before the messages.
function channelRecords(layout: Layout): Uint8Array {
  const builder = new McapRecordBuilder();
  for (const channel of layout.channels) builder.writeChannel(channel);
  return builder.buffer.slice();
}

/// @param bytes  of the chunk's record
/// @throws Error if they are damaged, incomplete or encrypted
export function decodeChunk(bytes: Uint8Array, layout: Layout): ChunkContent {
  const reader = new McapStreamReader({ noMagicPrefix: true, decompressHandlers, validateCrcs: true });
  reader.append(channelRecords(layout));
  reader.append(bytes);
  const poses: Timed<Uint8Array>[] = [];
  const geometries: Timed<Uint8Array>[] = [];
  const events: Timed<EventFacts>[] = [];
  const gaps: Timed<GapFacts>[] = [];
  const stations: Timed<StationFacts>[] = [];
  const changes: Timed<ChangeFacts>[] = [];
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type !== "Message") continue;
    const { data } = record;
    const time = secondsSince(layout.begin, record.logTime);
    switch (layout.topics.get(record.channelId)) {
      case "/pose":
        poses.push({ time, value: data.slice() }); // a view would keep the whole chunk
        break;
      case "/geometry":
        geometries.push({ time, value: data.slice() });
        break;
      case "/event": {
        const { code, who, text } = fromBinary(EventSchema, data);
        events.push({ time, value: { code, who, text } });
        break;
      }
      case "/gap": {
        const { firstTick, lastTick, why } = fromBinary(GapSchema, data);
        gaps.push({ time, value: { steps: Number(lastTick - firstTick) + 1, why } });
        break;
      }
      case "/setup":
        stations.push({ time, value: stationFacts(data) });
        break;
      case "/change":
        changes.push({ time, value: changeFacts(data) });
        break;
      case undefined:
        break;
    }
  }
  if (bytes[0] !== kChunkRecord || reader.bytesRemaining() > 0) throw new Error("no whole chunk");
  return { poses, geometries, events, gaps, stations, changes };
}

/// @throws as decodeChunk
export function surveyChunk(bytes: Uint8Array, layout: Layout): ChunkSurvey {
  const { poses, events, gaps, stations, geometries } = decodeChunk(bytes, layout);
  const forces = new Float64Array(kSurveyRow * poses.length);
  poses.forEach(({ time, value }, i) => forces.set([time, ...digitForces(fromBinary(TickSchema, value))], kSurveyRow * i));
  const rates = geometries.map(({ time, value }) => ({ time, value: rateOf(value) }));
  return { forces, events, gaps, stations, rates };
}
