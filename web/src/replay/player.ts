// SPDX-License-Identifier: Apache-2.0
// A recording that is shown: feeds view, plots and figures with what was measured at the displayed moment. It has no connection to a
// station and no way to send anything.
import { fromBinary } from "@bufbuild/protobuf";
import { TickSchema, type Tick } from "../gen/phalanx/tick_pb";
import { channels, fillRow, isMeasured } from "../state/channels";
import { CircumstanceNumbers, type Circumstances } from "../state/circumstances";
import { isPlotted, type Happened } from "../state/happened";
import { capacityFor, History } from "../state/history";
import { Listeners } from "../state/listeners";
import type { OldCurves, Shown, Topic } from "../state/shown";
import { VerdictLight } from "../state/verdict";
import type { Shapes } from "../view3d/shapes";
import type { Timed } from "./chunk";
import { ChunkCache } from "./chunk_cache";
import type { Decoder } from "./decoder";
import { Lookup } from "./lookup";
import { Playhead } from "./playhead";
import type { Recording } from "./recording";
import { rateOf, type ChangeFacts, type StationFacts } from "./station_facts";

export const kOldPose = 0.25; // [s]: a pose that is older than the displayed moment does not show it; as a gap in the curves
export const kLongRead = 300; // a shorter wait is not displayed [ms]
const kWindows: readonly number[] = [10, 60]; // [s]: a longer one would read too many chunks for each moment
const kPoseInterval = 1 / 60; // [s]
const kFrame = 0.3; // [s] that a frame may move on, at speed 1
const kAhead = 4; // [s] that are loaded ahead, at speed 1
const kShapes = 3; // geometries that are kept
const kJustBefore = 1e-7; // [s], much less than a step

export class Player extends Listeners<Topic> implements Shown {
  tick: Tick | undefined;
  geometry: Shapes | undefined;
  light = new VerdictLight();
  station: StationFacts | undefined; // in force at the displayed moment
  trouble: unknown; // why nothing more can be read
  shapesTrouble = false; // the geometry cannot be made into shapes
  readonly windows = kWindows;
  readonly history = new History(channels.length, capacityFor(kWindows.at(-1)!));
  events: readonly Happened[] = []; // by the recording's time, in its order
  readonly playhead: Playhead;
  private seconds = kWindows[0]!; // that the history covers
  private readonly numbers = new CircumstanceNumbers();
  private inForce = NaN; // number of the circumstances; NaN: not known
  private change: (ChangeFacts & { readonly since: number }) | undefined; // in force at the displayed moment
  private readonly lookup: Lookup;
  private readonly cache: ChunkCache;
  private readonly row = new Float64Array(channels.length);
  private readonly shapes = new Map<string, Shapes>(); // by place in the recording, the oldest first
  private shape = ""; // of these the one that is shown
  private rate = 0; // of its station, steps a second; 0: not known
  private shownAt = NaN; // time of `tick`
  private fed = NaN; // time up to which the history is filled; NaN: it is empty
  private until = -Infinity; // time at which another station or geometry comes
  private settling: Promise<void> | undefined;
  private ahead: Promise<void> | undefined;
  private steps: Promise<void> = Promise.resolve();
  private stepping = 0; // steps that are not done yet
  private chosen = 0; // moments that were chosen so far, other than by steps
  private waitsSince: number | undefined; // the shown pose is not that of the displayed moment since [ms]
  private waitsLong = false;

  /// @param makeShapes  of the bytes of a Geometry
  constructor(
    readonly recording: Recording,
    decoder: Decoder,
    private readonly makeShapes: (bytes: ArrayBuffer) => Promise<Shapes>,
  ) {
    super();
    this.cache = new ChunkCache(recording, decoder);
    this.lookup = new Lookup(recording, this.cache);
    this.playhead = new Playhead(recording.seconds, () => this.tell("own"));
  }

  get sensedJoint(): readonly number[] {
    return this.station?.sensedJoint ?? [];
  }

  get rendersTorque(): boolean {
    return this.station?.rendersTorque ?? true;
  }

  get slides(): boolean {
    return this.change?.slides ?? false;
  }

  get objectKind(): string {
    return this.change?.objectKind ?? "";
  }

  get digitLimit(): number {
    return this.change?.digitLimit ?? Infinity;
  }

  get recordedAt(): number {
    return Number(this.recording.layout.begin) / 1e9 + this.playhead.position;
  }

  /// The ticks' clock minus the recording's time [s]. NaN: no pose is shown.
  private get clock(): number {
    return this.tick ? this.tick.time - this.shownAt : NaN;
  }

  get utcOffset(): number {
    return Number(this.recording.layout.begin) / 1e9 - this.clock;
  }

  get happened(): readonly Happened[] {
    const { clock } = this;
    if (Number.isNaN(clock)) return [];
    return this.events.filter(({ code }) => isPlotted(code)).map((one) => ({ ...one, time: one.time + clock }));
  }

  get circumstances(): readonly Circumstances[] {
    return this.numbers.all;
  }

  reachBack(seconds: number): void {
    if (seconds === this.seconds) return;
    this.seconds = seconds;
    this.go(this.playhead.position);
  }

  /// The shown pose is not that of the displayed moment.
  private get away(): boolean {
    const { position } = this.playhead;
    return !(Math.abs(position - this.shownAt) <= kOldPose) || this.lookup.missing(position, this.rate);
  }

  /// The recording has no pose of the displayed moment: steps are missing, or there was no station.
  get hole(): boolean {
    return !this.loading && this.away;
  }

  /// While a moment is read, the one before stays for a short time, so that nothing flickers.
  get lost(): boolean {
    return !this.tick || !isMeasured(this.tick) || (this.away && (!this.loading || this.waitsLong));
  }

  /// Likewise if the object in the picture is not that of the displayed moment.
  get viewDead(): boolean {
    return this.lost || this.geometry === undefined;
  }

  get oldCurves(): OldCurves {
    return this.tick && !isMeasured(this.tick) ? "unmeasured" : "";
  }

  /// What is to be shown has not been read yet.
  get loading(): boolean {
    return this.settling !== undefined;
  }

  get damagedChunks(): number {
    return this.cache.damaged;
  }

  /// Shows another moment, as soon as it is read.
  seek(time: number): void {
    ++this.chosen;
    this.go(time);
  }

  /// Shows the first pose. It may come long after the begin.
  async seekFirst(): Promise<void> {
    this.seek(0);
    const { chosen } = this;
    try {
      const first = await this.lookup.poseAfter(-kJustBefore);
      if (first && first.time > kOldPose && chosen === this.chosen) this.seek(first.time);
    } catch (reason) {
      this.fail(reason);
    }
  }

  private go(time: number): void {
    this.playhead.seek(time);
    this.fed = NaN;
    this.tell("own");
    void this.settle();
  }

  /// Goes by whole poses. One step waits at most: a key that is held down asks for more than can be read.
  /// @param direction  1: to the next one, -1: to the one before
  step(direction: 1 | -1): Promise<void> {
    this.playhead.pause();
    if (this.stepping >= 2) return this.steps;
    ++this.stepping;
    const { chosen } = this;
    this.steps = this.steps.then(() => this.goStep(direction, chosen)).finally(() => --this.stepping);
    return this.steps;
  }

  /// @param chosen  `chosen` when the step was asked for: a moment that was chosen later has precedence
  private async goStep(direction: 1 | -1, chosen: number): Promise<void> {
    await this.settling;
    const from = Number.isNaN(this.shownAt) ? this.playhead.position : this.shownAt;
    try {
      const next = await (direction > 0 ? this.lookup.poseAfter(from) : this.lookup.last("/pose", from - kJustBefore));
      if (chosen !== this.chosen || this.playhead.playing) return;
      if (next) this.go(next.time);
      await this.settling;
    } catch (reason) {
      this.fail(reason);
    }
  }

  /// Tries again what could not be read.
  retry(): void {
    this.trouble = undefined;
    this.seek(this.playhead.position);
  }

  /// Called once a frame. @param now  [ms]
  frame(now: number): void {
    const { playhead } = this;
    const soon = Math.min(playhead.length, playhead.position + kFrame * playhead.speed);
    const ready = !this.settling && !Number.isNaN(this.fed) && this.lookup.ready(this.fed, soon);
    playhead.frame(now, !ready);
    this.waitsSince = this.loading && this.away ? (this.waitsSince ?? now) : undefined;
    this.waitsLong = this.waitsSince !== undefined && now - this.waitsSince > kLongRead;
    if (ready && playhead.position < this.fed) this.go(playhead.position); // from the end to the beginning
    else if (ready && playhead.position > this.fed) this.feed(playhead.position);
    if (playhead.playing && !this.settling) this.loadAhead();
  }

  /// Resolves when the displayed moment is shown.
  settle(): Promise<void> {
    this.settling ??= this.goThere()
      .catch((reason: unknown) => this.fail(reason))
      .finally(() => {
        this.settling = undefined;
        this.tell("own");
      });
    return this.settling;
  }

  private async goThere(): Promise<void> {
    await Promise.resolve(); // `settling` is set
    while (Number.isNaN(this.fed)) {
      const at = this.playhead.position;
      const pose = (await this.lookup.last("/pose", at)) ?? (await this.firstPose(at));
      await this.useStation(Math.max(at, pose?.time ?? at));
      this.show(pose);
      if (this.playhead.position !== at) continue; // another moment was chosen meanwhile
      const { seconds } = this;
      await this.lookup.load(at - seconds, at + kOldPose); // a gap is written behind the missing steps
      if (this.playhead.position !== at || this.seconds !== seconds) continue;
      this.history.clear();
      this.light = new VerdictLight();
      for (const { value } of this.lookup.poses(at - seconds, at)) this.record(fromBinary(TickSchema, value));
      this.fed = at;
      this.trouble = undefined;
      if (this.tick && this.history.length === 0) this.record(this.tick);
      this.recordHole(at);
      this.tell("tick");
    }
  }

  /// The recording begins a moment before its first pose.
  private async firstPose(at: number): Promise<Timed<Uint8Array> | undefined> {
    const first = await this.lookup.poseAfter(at);
    return first && first.time - at < kOldPose ? first : undefined;
  }

  /// Goes on to a time whose chunks are at hand.
  private feed(to: number): void {
    if (to >= this.until) {
      this.go(to); // another station or object
      return;
    }
    const poses = this.lookup.poses(this.fed, to);
    this.fed = to;
    const ticks = poses.map(({ value }) => fromBinary(TickSchema, value));
    ticks.forEach((tick) => this.record(tick));
    const last = poses.at(-1);
    if (last) this.shownAt = last.time;
    this.tick = ticks.at(-1) ?? this.tick;
    this.recordHole(to);
    this.tell("tick");
  }

  private record(tick: Tick): void {
    const known = this.change && tick.time - this.clock >= this.change.since; // what was in force before is not read
    fillRow(tick, this.row, known ? this.inForce : NaN);
    this.history.push(tick.time, this.row);
    this.light.feed(tick, tick.time);
  }

  /// The curves end where the steps do, not at the displayed moment. A hole takes no more of the history than poses would.
  private recordHole(at: number): void {
    if (!this.tick || !(at - this.shownAt > kOldPose)) return;
    const time = this.tick.time + at - this.shownAt;
    if (time - this.history.end < kPoseInterval) return;
    this.row.fill(NaN);
    this.history.push(time, this.row);
  }

  private show(pose: Timed<Uint8Array> | undefined): void {
    this.tick = pose && fromBinary(TickSchema, pose.value);
    this.shownAt = pose?.time ?? NaN;
    this.waitsSince = undefined;
    this.waitsLong = false;
    this.tell("tick");
  }

  /// The station and the geometry in force.
  private async useStation(at: number): Promise<void> {
    const [setup, change] = [await this.lookup.last("/setup", at), await this.lookup.last("/change", at)];
    this.station = setup?.value;
    const last = change && change.time > (setup?.time ?? -Infinity) ? change : setup;
    this.change = last && { ...last.value, since: last.time };
    this.tell("state");
    const geometry = await this.lookup.last("/geometry", at);
    const place = geometry ? `${geometry.chunk} ${geometry.time}` : "";
    if (place !== this.shape) {
      const made = geometry && (this.shapes.get(place) ?? (await this.makeShapes(geometry.value.slice().buffer).catch(() => undefined)));
      this.shapesTrouble = geometry !== undefined && made === undefined;
      this.shape = place;
      this.rate = geometry ? rateOf(geometry.value) : 0;
      if (made) {
        this.shapes.delete(place);
        this.shapes.set(place, made);
        for (const oldest of this.shapes.keys()) if (this.shapes.size > kShapes) this.shapes.delete(oldest);
      }
      this.geometry = made;
      this.tell("geometry");
    }
    this.inForce = this.change ? this.numbers.of(this.circumstancesOf(this.change)) : NaN;
    this.until = this.lookup.next(["/geometry", "/setup", "/change"], at);
  }

  private circumstancesOf({ scene, law, stabiliser, rate }: ChangeFacts): Circumstances {
    const { device = "", simulated } = this.station ?? {};
    return { scene, law, stabiliser, rate: rate || String(this.rate || ""), device, simulated };
  }

  private loadAhead(): void {
    const { position, speed, length } = this.playhead;
    const to = Math.min(length, position + kAhead * Math.max(1, speed));
    if (this.ahead || this.lookup.ready(position, to)) return;
    this.ahead = this.lookup
      .load(position, to)
      .catch((reason: unknown) => this.fail(reason))
      .finally(() => (this.ahead = undefined));
  }

  private fail(reason: unknown): void {
    this.trouble = reason;
    this.playhead.pause();
    this.tell("own");
  }
}
