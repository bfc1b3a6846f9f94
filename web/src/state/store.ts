// SPDX-License-Identifier: Apache-2.0
// The state that the page knows. Panels read it and are called when a part of it has changed.
import type { Notice, State, ToPage, Welcome } from "../gen/phalanx/cockpit_pb";
import { SafetyState, type Tick } from "../gen/phalanx/tick_pb";
import type { Shapes } from "../view3d/shapes";
import type { Phase } from "../wire/connection";
import { channels, fillRow } from "./channels";
import { CircumstanceNumbers, type Circumstances } from "./circumstances";
import { Delivery } from "./delivery";
import { Freshness } from "./freshness";
import { happenedOf, type Happened } from "./happened";
import { capacityFor, History } from "./history";
import { isChanged, kDigitLimit, limitOf, objectKind, slides, valueOf } from "./keys";
import { Listeners } from "./listeners";
import { roleOf, type Role } from "./roles";
import type { OldCurves, Pausing, Shown, Topic } from "./shown";
import { same, unquote } from "./toml";
import { VerdictLight } from "./verdict";

const kWindows: readonly number[] = [10, 60, 300]; // [s]
const kNoticesKept = 200;
const kPendingMs = 1500;
/// The station sends its State twice a second; an older one does not count as the present state [ms].
export const kStateStaleMs = 1500;

interface Pending {
  readonly value: string;
  until: number; // forgotten then [ms]; Infinity: its answer is awaited
}

export class Store extends Listeners<Topic> implements Shown, Pausing {
  phase: Phase = "connecting";
  welcome: Welcome | undefined;
  state: State | undefined;
  tick: Tick | undefined;
  geometry: Shapes | undefined;
  private shape: number | undefined; // revision of `geometry`, if it is of this connection's station
  private stateAt = -Infinity; // when `state` came [ms]; of this connection
  notices: Notice[] = [];
  paused = false;
  readonly light = new VerdictLight();
  readonly delivery = new Delivery();
  readonly windows = kWindows;
  readonly history = new History(channels.length, capacityFor(kWindows.at(-1)!));
  happened: readonly Happened[] = [];
  private readonly numbers = new CircumstanceNumbers();
  private inForce = NaN; // number of the circumstances; NaN: not known
  readonly freshness: Freshness;
  private readonly pending = new Map<string, Pending>();
  private readonly row = new Float64Array(channels.length);

  constructor(private readonly now: () => number = () => performance.now()) {
    super();
    this.freshness = new Freshness(now());
  }

  get connected(): boolean {
    return this.phase === "open";
  }

  /// No connection, or nothing that was measured newly for too long.
  get lost(): boolean {
    return !this.connected || this.freshness.stale(this.now());
  }

  /// The station lives and is heard, but its device does not measure: what is lost is the hand, not the connection.
  get unmeasured(): boolean {
    if (!this.connected || !this.lost) return false;
    const known = this.known;
    const waits = known?.safety === SafetyState.SAFETY_WAITING && !known.stationGone && known.busy === "" && !known.wizard;
    return waits || this.freshness.unmeasured(this.now());
  }

  /// Nothing has come because the page did not listen: its own work took too long.
  get busyWithItself(): boolean {
    return this.connected && this.lost && !this.unmeasured && !this.freshness.silent;
  }

  /// The newest State of this connection's station; undefined: none has come.
  private get present(): State | undefined {
    return this.stateAt === -Infinity ? undefined : this.state;
  }

  /// The newest State of the station; undefined: no connection, or it has been silent for too long.
  get known(): State | undefined {
    return this.connected && this.now() - this.stateAt <= kStateStaleMs ? this.state : undefined;
  }

  /// The displayed shape is not the one in force, whose shape has not arrived yet.
  get shapeMissing(): boolean {
    const state = this.connected ? this.present : undefined;
    return state !== undefined && !state.stationGone && state.geometry !== this.shape;
  }

  /// A calibration is on, and shows the hand in place of the station.
  get calibrating(): boolean {
    return (this.known?.wizard?.hand.length ?? 0) > 0;
  }

  /// The picture is old.
  get viewDead(): boolean {
    return (this.lost && !this.calibrating) || this.shapeMissing;
  }

  get oldCurves(): OldCurves {
    if (!this.connected) return "offline";
    if (!this.lost || this.busyWithItself) return "";
    return this.unmeasured ? "unmeasured" : "silent";
  }

  get slides(): boolean {
    return slides(this.state, this.welcome);
  }

  get sensedJoint(): readonly number[] {
    return this.state?.sensedJoint ?? [];
  }

  get rendersTorque(): boolean {
    return this.state?.rendersTorque !== false;
  }

  get objectKind(): string {
    return objectKind(this.state, this.welcome);
  }

  get digitLimit(): number {
    return limitOf(valueOf(this.state, this.welcome, kDigitLimit));
  }

  get utcOffset(): number {
    return this.welcome ? this.welcome.unixTime - this.welcome.clock : NaN;
  }

  get circumstances(): readonly Circumstances[] {
    return this.numbers.all;
  }

  /// The history is always as long as the longest window.
  reachBack(): void {}

  get role(): Role {
    return roleOf(this.connected, this.welcome, this.present);
  }

  setPhase(phase: Phase): void {
    this.phase = phase;
    if (phase !== "open") {
      this.pending.clear();
      this.shape = undefined; // another station counts its revisions from the beginning
      this.stateAt = -Infinity;
      this.inForce = NaN;
    } else {
      this.freshness.listen();
    }
    this.tell("connection");
  }

  setGeometry(geometry: Shapes, revision: number): void {
    this.geometry = geometry;
    this.shape = revision;
    this.tell("geometry");
  }

  setPaused(paused: boolean): void {
    this.paused = paused;
    this.tell("own");
  }

  receive(message: ToPage): void {
    const what = message.what;
    switch (what.case) {
      case "welcome":
        this.welcome = what.value;
        this.notices = [...what.value.past];
        this.happened = happenedOf(this.notices, this.utcOffset);
        this.tell("connection");
        this.tell("notice");
        break;
      case "state":
        this.state = what.value;
        this.stateAt = this.now();
        this.inForce = this.numbers.of(this.circumstancesOf(what.value));
        if (what.value.stationGone || what.value.busy !== "" || what.value.wizard) this.delivery.rest();
        this.settle();
        this.tell("state");
        break;
      case "tick":
        this.step(what.value);
        break;
      case "notice":
        this.notices.push(what.value);
        if (this.notices.length > kNoticesKept) this.notices.shift();
        this.happened = happenedOf(this.notices, this.utcOffset);
        this.tell("notice");
        break;
      case "reply":
      case undefined:
        break;
    }
  }

  private circumstancesOf(state: State): Circumstances {
    const value = (setting: string) => unquote(valueOf(state, this.welcome, setting));
    return {
      scene: state.scene,
      law: value("force.law"),
      stabiliser: value("stabiliser.method"),
      rate: value("rate_hz"),
      device: state.deviceName,
      simulated: state.deviceSimulated,
    };
  }

  private step(tick: Tick): void {
    if (!this.freshness.take(tick, this.now())) return;
    this.delivery.feed(tick, this.now() / 1000);
    this.tick = tick;
    this.light.feed(tick, this.now() / 1000);
    if (!this.paused) {
      fillRow(tick, this.row, this.inForce);
      this.history.push(tick.time, this.row);
    }
    this.tell("tick");
  }

  // ---- values of keys; a value that this page has requested counts until the station has answered

  value(setting: string): string {
    const asked = this.pending.get(setting);
    if (asked && this.now() < asked.until) return asked.value;
    return valueOf(this.state, this.welcome, setting);
  }

  changed(setting: string): boolean {
    return isChanged(this.state, setting);
  }

  /// Records a request; an empty value requests the scene's own, which is not known here.
  asked(setting: string, value: string): void {
    if (value !== "") this.pending.set(setting, { value, until: Infinity });
  }

  /// Records an answer. A granted value counts for a moment more: the State that has it may still be on its way.
  answered(setting: string, value: string, ok: boolean): void {
    const asked = this.pending.get(setting);
    if (!asked || asked.value !== value) return;
    if (ok) asked.until = this.now() + kPendingMs;
    else this.pending.delete(setting);
    this.settle();
  }

  private settle(): void {
    for (const [setting, asked] of this.pending) {
      const done = asked.until !== Infinity && same(asked.value, valueOf(this.state, this.welcome, setting));
      if (done || this.now() >= asked.until) this.pending.delete(setting);
    }
  }
}
