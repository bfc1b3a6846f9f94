// SPDX-License-Identifier: Apache-2.0
// Asks the station again and again which exercise runs: often while one is under way, seldom otherwise. One request at a time, so that a slow
// connection gets no queue of them.
import { isUnderWay, type ExerciseNow } from "./exercise_now";

export const kQuickMs = 200;
export const kSlowMs = 2000;
export const kStaleMs = 2000; // without an answer: what is displayed is no longer live

export class ExerciseWatch {
  private running = 0; // number of the begin; 0: it does not ask
  private begun = 0;
  private answered = 0; // time of the last answer, or of the begin [ms]
  private quick = false;
  private waiting: (() => void) | undefined; // wakes the one that waits

  /// @param ask     the station
  /// @param got     gets each answer
  /// @param failed  gets each failure  @param stale  whether the station has not answered for kStaleMs
  /// @param late    is called when it has not answered for kStaleMs while an exercise is under way, also while a request still waits
  /// @param time    [ms]  @param later   runs a function after a time [ms]
  constructor(
    private readonly ask: () => Promise<ExerciseNow>,
    private readonly got: (now: ExerciseNow) => void,
    private readonly failed: (reason: unknown, stale: boolean) => void,
    private readonly late: () => void,
    private readonly time: () => number,
    private readonly later: (run: () => void, ms: number) => void = (run, ms) => void setTimeout(run, ms),
  ) {}

  begin(): void {
    if (this.running !== 0) return;
    this.running = ++this.begun;
    this.answered = this.time();
    void this.go(this.running);
  }

  end(): void {
    this.running = 0;
    this.waiting = undefined;
  }

  /// Asks at once: a person has just done something.
  now(): void {
    this.waiting?.();
  }

  private async go(mine: number): Promise<void> {
    while (this.running === mine) {
      this.later(() => this.check(mine), kStaleMs);
      try {
        const now = await this.ask();
        if (this.running !== mine) return;
        this.answered = this.time();
        this.quick = isUnderWay(now);
        this.got(now);
      } catch (reason) {
        if (this.running !== mine) return;
        this.failed(reason, this.isStale());
      }
      await this.wait(this.quick ? kQuickMs : kSlowMs);
    }
  }

  private isStale(): boolean {
    return this.time() - this.answered >= kStaleMs;
  }

  private check(mine: number): void {
    if (this.running === mine && this.quick && this.isStale()) this.late();
  }

  private wait(ms: number): Promise<void> {
    return new Promise((resolve) => {
      this.waiting = resolve;
      this.later(resolve, ms);
    });
  }
}
