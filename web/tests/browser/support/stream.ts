// SPDX-License-Identifier: Apache-2.0
// What came over a page's WebSocket, byte for byte as the browser got it, read without any code of the page's.
import { fromBinary } from "@bufbuild/protobuf";
import type { Page } from "playwright-core";
import { ToPageSchema, type Notice, type State, type Welcome } from "../../../src/gen/phalanx/cockpit_pb";
import type { Tick } from "../../../src/gen/phalanx/tick_pb";
import { until } from "./until";

const kKept = 4000; // ticks

export class Stream {
  welcome: Welcome | undefined;
  state: State | undefined;
  notices: Notice[] = [];
  ticks: Tick[] = []; // oldest first, of the present connection
  connections = 0;

  constructor(page: Page) {
    page.on("websocket", (socket) => {
      ++this.connections;
      this.ticks = [];
      socket.on("framereceived", ({ payload }) => typeof payload !== "string" && this.receive(payload));
    });
  }

  get newest(): Tick | undefined {
    return this.ticks.at(-1);
  }

  tick(number: bigint): Tick | undefined {
    return this.ticks.filter((tick) => tick.tick === number).at(-1);
  }

  /// Ticks that come from now on, `count` of them or more. Their numbers do not tell new ones from old ones: they start again when the device changes.
  async next(count: number): Promise<Tick[]> {
    const newest = this.newest;
    const connection = this.connections;
    return until(
      `${count} more ticks`,
      () => {
        if (this.connections !== connection) throw new Error("the page has connected anew meanwhile");
        const fresh = this.ticks.slice(newest === undefined ? 0 : this.ticks.lastIndexOf(newest) + 1);
        return fresh.length >= count && fresh;
      },
      () => `the newest is ${this.newest?.tick}`,
    );
  }

  private receive(payload: Buffer): void {
    const what = fromBinary(ToPageSchema, payload).what;
    if (what.case === "welcome") {
      this.welcome = what.value;
      this.notices = [...what.value.past];
    } else if (what.case === "state") {
      this.state = what.value;
    } else if (what.case === "notice") {
      this.notices.push(what.value);
    } else if (what.case === "tick") {
      this.ticks.push(what.value);
      if (this.ticks.length > 2 * kKept) this.ticks = this.ticks.slice(-kKept);
    }
  }
}
