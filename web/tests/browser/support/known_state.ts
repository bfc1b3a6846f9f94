// SPDX-License-Identifier: Apache-2.0
// A station that stories share is put into a known state through its own protocol.
import { create, fromBinary, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import { HandSource, ToHostSchema, ToPageSchema, type State } from "../../../src/gen/phalanx/cockpit_pb";
import { SafetyState } from "../../../src/gen/phalanx/tick_pb";
import { kProtocol } from "../../../src/wire/connection";
import { until } from "./until";
import { WebSocketClient } from "./web_socket";

export type Values = Readonly<Record<string, string>>; // by key, as they would stand in a scene file
type What = NonNullable<MessageInitShape<typeof ToHostSchema>["what"]>;

/// A page of the station without a browser.
class Caretaker {
  state: State | undefined;
  private readonly answers = new Map<number, string>(); // by request; empty: done
  private requests = 0;
  private line: WebSocketClient | undefined;

  async connect(url: string): Promise<void> {
    let protocol = 0;
    this.line = await WebSocketClient.connect(url, (message) => {
      const { what } = fromBinary(ToPageSchema, message);
      if (what.case === "welcome") protocol = what.value.protocol;
      if (what.case === "state") this.state = what.value;
      if (what.case === "reply") this.answers.set(what.value.request, what.value.ok ? "" : what.value.error || "refused");
    });
    this.line.send(toBinary(ToHostSchema, create(ToHostSchema, { what: { case: "hello", value: { protocol: kProtocol } } })));
    await until("the station's welcome", () => protocol === kProtocol && this.state !== undefined);
  }

  /// @throws Error if the station refuses
  async ask(what: What): Promise<void> {
    const request = ++this.requests;
    this.line!.send(toBinary(ToHostSchema, create(ToHostSchema, { request, what })));
    const refused = await until(`an answer to ${what.case}`, () => (this.answers.has(request) ? { why: this.answers.get(request)! } : false));
    if (refused.why !== "") throw new Error(`${what.case}: ${refused.why}`);
  }

  untilState(what: string, is: (state: State) => boolean): Promise<boolean> {
    return until(what, () => is(this.state!), () => JSON.stringify(this.state, (_, value: unknown) => (typeof value === "bigint" ? String(value) : value)));
  }

  close(): void {
    this.line?.close();
  }
}

/// Loads a scene as its file has it, with values laid over its keys, moved by the simulated patient, neither stopped nor in fault; no page is there, and none has control.
export async function bringToKnownState(url: string, scene: string, values: Values): Promise<void> {
  const keeper = new Caretaker();
  await keeper.connect(url);
  await keeper.untilState("the pages of the story before have left", (state) => state.pages === 1);
  await keeper.ask({ case: "take", value: {} });
  await keeper.ask({ case: "source", value: { source: HandSource.HAND_PATIENT } });
  await keeper.ask({ case: "scene", value: { name: scene } });
  await keeper.untilState("the scene", (state) => state.scene === scene && state.busy === "" && !state.stationGone);
  const setting = Object.entries(values).map(([key, value]) => ({ key, value }));
  if (setting.length > 0) await keeper.ask({ case: "set", value: { setting } });
  const { fault } = keeper.state!;
  if (fault) {
    await keeper.ask({ case: "reset", value: { faultTime: fault.time } });
    await keeper.untilState("no fault", (state) => state.fault === undefined);
  }
  if (keeper.state!.heldStopped) await keeper.ask({ case: "resume", value: { stops: keeper.state!.stops } });
  await keeper.untilState("the station runs", (state) => !state.heldStopped && state.changed.length === setting.length && state.busy === "" && state.safety === SafetyState.SAFETY_RUNNING);
  await keeper.ask({ case: "release", value: {} });
  keeper.close();
}

/// Takes control from a page that has gone, and gives it back: the next page that comes has it.
export async function freeControl(url: string): Promise<void> {
  const keeper = new Caretaker();
  await keeper.connect(url);
  await keeper.ask({ case: "take", value: {} });
  await keeper.ask({ case: "release", value: {} });
  keeper.close();
}
