// SPDX-License-Identifier: Apache-2.0
import type { Tick } from "../gen/phalanx/tick_pb";
import { isMeasured } from "./channels";

/// A picture older than this is not alive [ms].
export const kStaleMs = 500;
/// Where the page itself stood still, so much of the pause counts as the station's silence [ms].
const kPauseMs = 100;

/// The age of the displayed picture. It is fresh if a newer step from a new measurement has come within kStaleMs. A station whose device is
/// silent continues with the last sample and states it; one that was reset repeats the same step. A page that slept wakes with an old
/// picture, until the next step has come.
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

  /// True if the station has sent nothing for kStaleMs although the page listened. While a page is busy, for example as it loads its view,
  /// its picture is stale and the station is not silent.
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
