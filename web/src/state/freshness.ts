// SPDX-License-Identifier: Apache-2.0
import type { Tick } from "../gen/phalanx/tick_pb";
import { isMeasured } from "./channels";

/// A picture older than this is not alive [ms].
export const kStaleMs = 500;
/// Where the page itself stood still, so much of the pause counts as the station's silence [ms].
const kPauseMs = 100;

/// Whether what is shown is alive: a newer step, made from a fresh measurement, has come within kStaleMs. A station whose device is
/// silent goes on with the last sample and says so; one that was reset says the same step again and again. A page that slept
/// wakes with a picture that is not alive, until the next step has come.
export class Freshness {
  private measuredAt = -Infinity; // when the newest measured step came [ms], on the page's clock
  private heardAt = -Infinity; // when the station's clock was last seen to go on [ms], likewise
  private readonly since: number;
  private measured = true; // the newest step
  private step: bigint | undefined;
  private time: number | undefined; // the station's
  private beatAt: number;
  private unheardMs = 0; // while the page listened, since the newest step

  constructor(now: number) {
    this.since = now;
    this.beatAt = now;
  }

  /// The line is open from now on: the station has not been silent yet.
  listen(): void {
    this.unheardMs = 0;
  }

  /// The page runs, and has had the chance to hear: once a frame.
  beat(now: number): void {
    this.unheardMs += Math.min(now - this.beatAt, kPauseMs);
    this.beatAt = now;
  }

  /// The station has said nothing for kStaleMs although the page listened. A page that was busy with itself, as while it brings in its
  /// view, has a picture that is stale and a station that is not silent.
  get silent(): boolean {
    return this.unheardMs >= kStaleMs;
  }

  /// @returns whether the step is a new one
  take(tick: Tick, now: number): boolean {
    if (tick.time !== this.time) this.heardAt = now;
    this.time = tick.time;
    if (tick.tick === this.step) return false;
    this.unheardMs = 0;
    this.step = tick.tick;
    this.measured = isMeasured(tick);
    if (this.measured) this.measuredAt = now;
    return true;
  }

  /// Milliseconds since the last measured step; since the page began, if there was none.
  age(now: number): number {
    return this.ever ? now - this.measuredAt : now - this.since;
  }

  stale(now: number): boolean {
    return !this.measured || now - Math.max(this.measuredAt, this.since) > kStaleMs;
  }

  /// The station goes on, but not from what is measured now.
  unmeasured(now: number): boolean {
    return this.stale(now) && now - this.heardAt <= kStaleMs;
  }

  get ever(): boolean {
    return this.measuredAt !== -Infinity;
  }
}
