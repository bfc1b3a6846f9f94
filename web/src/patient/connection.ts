// SPDX-License-Identifier: Apache-2.0
// The screen's line to the station. It sends STOP, pause, pain and tired; nothing else.
import { create } from "@bufbuild/protobuf";
import { Feel_Kind, FeelSchema, type State, type ToPage } from "../gen/phalanx/cockpit_pb";
import { Connection, type Answer, type Memory, type Socket } from "../wire/connection";
import { Host } from "../wire/host";
import { StopOrder, type StopProgress } from "../wire/stop_order";
import type { Rating } from "./game";
import { exerciseOf, nothingKnown, withState, type Known } from "./state";

const kFeelMs = 600; // time that a pause has to be confirmed before STOP is sent in its place

export interface StationParts {
  readonly openSocket: () => Socket;
  readonly secret: Memory;
  readonly postStop: (secret: string) => Promise<boolean>; // by HTTP
  readonly linkExpired?: () => Promise<boolean>;
  readonly changed: () => void; // what is known has changed
  readonly stopping: (progress: StopProgress) => void;
}

export class Station {
  known: Known = nothingKnown;
  private readonly connection: Connection;
  private readonly order: StopOrder;
  private state: State | undefined;

  constructor(private readonly parts: StationParts) {
    this.connection = new Connection({
      openSocket: parts.openSocket,
      secret: parts.secret,
      name: () => "",
      patientScreen: true,
      onPhase: (connected) => {
        if (connected !== "open") this.state = undefined; // an older number of stops would confirm a stop too early
        const open = connected === "open";
        if (open) this.order.welcomed(); // first: nothing that the page does may keep an owed stop back
        // At a new connection the exercise of the former one may be long over: the station says what runs now.
        this.change({ ...this.known, connected, ever: this.known.ever || open, exercise: open ? undefined : this.known.exercise });
      },
      onMessage: (message) => this.received(message),
      ...(parts.linkExpired ? { linkExpired: parts.linkExpired } : {}),
    });
    const host = new Host(this.connection, () => parts.postStop(parts.secret.get()));
    this.order = new StopOrder((atOnce) => host.stop(atOnce ? 0 : undefined), () => parts.stopping(this.order.progress));
  }

  start(): void {
    this.connection.start();
  }

  stop(): void {
    this.order.press(this.state);
  }

  /// Asks for a break, whose first effect is that the torque goes. Without a connection, or if no answer comes in time, STOP is sent in its place.
  async pause(): Promise<Answer> {
    const asked = this.feel(Feel_Kind.PAUSE, 0);
    const late = new Promise<Answer>((resolve) => setTimeout(() => resolve({ ok: false, error: "" }), kFeelMs));
    const answer = await Promise.race([asked, late]);
    if (!answer.ok) this.stop();
    return answer;
  }

  /// @param value  0 .. 10
  rate(kind: Rating, value: number): Promise<Answer> {
    return this.feel(kind === "pain" ? Feel_Kind.PAIN : Feel_Kind.TIRED, value);
  }

  private feel(kind: Feel_Kind, value: number): Promise<Answer> {
    return this.connection.ask({ case: "feel", value: create(FeelSchema, { kind, value }) });
  }

  private received(message: ToPage): void {
    const { what } = message;
    if (what.case === "state") {
      this.state = what.value;
      this.order.heard(what.value);
      this.change(withState(this.known, what.value));
    } else if (what.case === "exercise") {
      this.change({ ...this.known, exercise: what.value.number === 0 ? undefined : exerciseOf(what.value) });
    }
  }

  private change(known: Known): void {
    this.known = known;
    this.parts.changed();
  }
}
