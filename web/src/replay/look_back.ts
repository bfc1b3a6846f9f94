// SPDX-License-Identifier: Apache-2.0
// The hand at an earlier moment of the running session, out of the recording that the station is writing.
import { fromBinary } from "@bufbuild/protobuf";
import { TickSchema, type Tick } from "../gen/phalanx/tick_pb";
import type { Shapes } from "../view3d/shapes";
import { ChunkCache } from "./chunk_cache";
import { threadDecoder, type Decoder } from "./decoder";
import { Lookup } from "./lookup";
import { kOldPose } from "./player";
import { openRecording, type Recording } from "./recording";
import type { Source } from "./source";

export interface PastHand {
  readonly tick: Tick;
  readonly geometry: Shapes | undefined; // undefined: none is recorded before this moment
}

interface Opened {
  readonly until: bigint;
  readonly recording: Recording;
  readonly lookup: Lookup;
  readonly decoder: Decoder;
}

const kHalfPose = 0.5 / 60; // [s]
const kSameClock = 1e-3; // [s]

export class LookBack {
  private opened: Opened | undefined;
  private ended = false;
  private newest: { readonly time: number; readonly shapes: Shapes } | undefined; // made of the geometry of this time in the recording
  private clock = NaN; // the ticks' clock minus the recording's time [s]

  /// @param open  the recording as it was when it had so many bytes
  constructor(
    private readonly open: (until: bigint) => Source,
    private readonly makeShapes: (bytes: ArrayBuffer) => Promise<Shapes>,
    private readonly decoderOf: (recording: Recording) => Decoder = ({ layout }) => threadDecoder(layout),
  ) {}

  /// @param time  on the ticks' clock [s]
  /// @param utcOffset  UTC minus that clock, as the page knows it [s]
  /// @param written  bytes of the recording that are on the disk
  /// @returns undefined: no step of this moment is on the disk
  /// @throws SourceError, FileError, DecoderError
  async at(time: number, utcOffset: number, written: bigint): Promise<PastHand | undefined> {
    const known = this.opened && (await this.poseAt(this.opened, time, utcOffset));
    if (known) return this.handOf(this.opened!, known);
    if (this.opened?.until === written) return undefined;
    this.opened?.decoder.close();
    this.opened = undefined;
    const recording = await openRecording(this.open(written));
    if (this.ended) return undefined; // nothing would close another thread
    const decoder = this.decoderOf(recording);
    this.opened = { until: written, recording, lookup: new Lookup(recording, new ChunkCache(recording, decoder)), decoder };
    const pose = await this.poseAt(this.opened, time, utcOffset);
    return pose && this.handOf(this.opened, pose);
  }

  /// Ends the reading. What is being read may never come.
  close(): void {
    this.ended = true;
    this.opened?.decoder.close();
    this.opened = undefined;
  }

  /// The computer's clock may have been set since the recording began: the poses themselves tell which time is theirs.
  private async poseAt({ recording, lookup }: Opened, time: number, utcOffset: number): Promise<{ tick: Tick; place: number } | undefined> {
    if (Number.isNaN(this.clock)) this.clock = Number(recording.layout.begin) / 1e9 - utcOffset;
    for (let tries = 0; tries < 2; ++tries) {
      const before = await lookup.last("/pose", time - this.clock + kHalfPose);
      const found = before ?? (tries === 0 ? await lookup.poseAfter(-Infinity) : undefined);
      if (!found) return undefined;
      const tick = fromBinary(TickSchema, found.value);
      const clock = tick.time - found.time;
      if (Math.abs(clock - this.clock) < kSameClock || tries > 0) return Math.abs(tick.time - time) <= kOldPose ? { tick, place: found.time } : undefined;
      this.clock = clock;
    }
    return undefined;
  }

  private async handOf({ lookup }: Opened, { tick, place }: { tick: Tick; place: number }): Promise<PastHand> {
    const geometry = await lookup.last("/geometry", place);
    if (!geometry) return { tick, geometry: undefined };
    const { time, value } = geometry;
    if (this.newest?.time !== time) this.newest = { time, shapes: await this.makeShapes(value.slice().buffer) };
    return { tick, geometry: this.newest.shapes };
  }
}
