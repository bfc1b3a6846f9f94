// SPDX-License-Identifier: Apache-2.0
// One browser page that shows recordings, and a recording read without any code of the page's.
import { readFileSync } from "node:fs";
import { fromBinary } from "@bufbuild/protobuf";
import { McapIndexedReader } from "@mcap/core";
import { decompress } from "fzstd";
import type { Page } from "playwright-core";
import { EventSchema } from "../../../src/gen/phalanx/recording_pb";
import { TickSchema, type Tick } from "../../../src/gen/phalanx/tick_pb";
import type { ViewProbe } from "../../../src/view3d/hand_view";
import { kHangMs, until } from "./until";

interface Displayed {
  readonly tick: Tick | undefined;
  readonly position: number; // [s]
  readonly view: ViewProbe | undefined;
  readonly samples: number; // in the plots
}

export class RecordingPage {
  readonly errors: string[] = [];
  readonly sent: string[] = []; // requests that are more than questions, and sockets
  private last = "";

  constructor(readonly page: Page) {
    page.on("pageerror", (error) => this.errors.push(String(error.stack ?? error)));
    page.on("websocket", (socket) => this.sent.push(socket.url()));
    page.on("request", (request) => request.method() !== "GET" && this.sent.push(`${request.method()} ${request.url()}`));
    page.setDefaultTimeout(kHangMs);
  }

  brief(): string {
    return this.last;
  }

  /// What is displayed once nothing is on its way any more.
  settled(what: string, is: (shown: Displayed) => boolean = () => true): Promise<Displayed> {
    return until(
      what,
      async () => {
        const shown = await this.page.evaluate(() => {
          const replay = window.phalanxReplay;
          if (!replay || replay.loading() || replay.tick() === undefined || !replay.view()?.shown.length) return undefined;
          return { tick: replay.tick(), position: replay.position(), view: replay.view(), samples: replay.history().samples };
        });
        this.last = `${what}: at ${shown?.position} s, tick ${shown?.tick?.tick}, drawn ${shown?.view?.tick}`;
        return shown?.view?.tick === shown?.tick?.tick && shown !== undefined && is(shown) && shown;
      },
      () => this.last,
    );
  }
}

export interface RecordedPose {
  readonly time: number; // since the begin [s]
  readonly tick: Tick;
}

/// The poses and events of a file.
export async function readRecording(file: string): Promise<{ poses: RecordedPose[]; events: { time: number; code: string; text: string }[]; seconds: number }> {
  const bytes = readFileSync(file);
  const readable = {
    size: () => Promise.resolve(BigInt(bytes.length)),
    read: (offset: bigint, size: bigint) => Promise.resolve(new Uint8Array(bytes.subarray(Number(offset), Number(offset + size)))),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers: { zstd: (part, size) => decompress(part, new Uint8Array(Number(size))) } });
  const { messageStartTime, messageEndTime } = reader.statistics!;
  const since = (time: bigint) => Number(time - messageStartTime) / 1e9;
  const poses: RecordedPose[] = [];
  const events: { time: number; code: string; text: string }[] = [];
  for await (const { channelId, logTime, data } of reader.readMessages({ topics: ["/pose", "/event"] })) {
    const time = since(logTime);
    if (reader.channelsById.get(channelId)!.topic === "/pose") poses.push({ time, tick: fromBinary(TickSchema, data) });
    else events.push({ time, ...fromBinary(EventSchema, data) });
  }
  return { poses, events, seconds: since(messageEndTime) };
}
