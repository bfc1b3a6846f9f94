// SPDX-License-Identifier: Apache-2.0
// The lock by time: after a while without a key, a press or a movement the page hides what it shows.

export interface IdleTimes {
  readonly lockMs: number; // without input
  readonly aliveMs: number; // between two reports to the station that a person is here
}

/// Counts the time since the last input. Its times are those of `now`, so that a computer that slept is locked when it wakes.
export class IdleLock {
  private last = 0;
  private told = 0;
  private running = false;

  /// @param alive  the person is here, and `aliveMs` have passed since the station was told so
  constructor(
    private readonly now: () => number,
    private readonly locks: () => void,
    private readonly alive: () => void,
    private times: IdleTimes = { lockMs: Infinity, aliveMs: Infinity },
  ) {}

  begin(times: IdleTimes): void {
    this.times = times;
    this.running = true;
    this.last = this.told = this.now();
  }

  end(): void {
    this.running = false;
  }

  /// Handles an input of the person. One that comes after the time is up does not prolong it.
  input(): void {
    if (!this.running || this.check()) return;
    this.last = this.now();
    if (this.last - this.told < this.times.aliveMs) return;
    this.told = this.last;
    this.alive();
  }

  /// Locks if the time is up. @returns whether it is
  check(): boolean {
    if (!this.running || this.now() - this.last < this.times.lockMs) return false;
    this.end();
    this.locks();
    return true;
  }
}
