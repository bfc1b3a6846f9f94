// SPDX-License-Identifier: Apache-2.0

/// A picture older than this is not alive [ms].
export const kStaleMs = 500;

/// Whether what is shown is alive: a step that is newer than the last one has come within kStaleMs. A page that was hidden is given
/// that time anew, as browsers hold back what happens in hidden pages.
export class Freshness {
  private newest = -Infinity; // [ms] on the page's clock
  private since = 0;
  private last: number | undefined; // the station's time of the newest step

  constructor(now: number) {
    this.since = now;
  }

  /// @returns whether the step is a new one
  tick(stationTime: number, now: number): boolean {
    if (stationTime === this.last) return false;
    this.last = stationTime;
    this.newest = now;
    return true;
  }

  visible(now: number): void {
    this.since = now;
  }

  /// Milliseconds since the last new step; since the page began, if there was none.
  age(now: number): number {
    return this.newest === -Infinity ? now - this.since : now - this.newest;
  }

  stale(now: number): boolean {
    return now - Math.max(this.newest, this.since) > kStaleMs;
  }

  get ever(): boolean {
    return this.newest !== -Infinity;
  }
}
