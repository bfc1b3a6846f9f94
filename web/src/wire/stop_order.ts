// SPDX-License-Identifier: Apache-2.0
// A stop that was pressed on this page. It is sent again and again until the station has confirmed it.
import type { State } from "../gen/phalanx/cockpit_pb";

/// none: not pressed; sent: on its way; owed: not confirmed, sent again; confirmed: the station has applied it.
export type StopProgress = "none" | "sent" | "owed" | "confirmed";

/// Interval at which an owed stop is sent again [ms].
export const kStopAgainMs = 1000;

export class StopOrder {
  private now: StopProgress = "none";
  private newest = 0; // number of the newest press
  private stopsThen = -1n; // State.stops when it was pressed; -1: anything newer counts
  private again: ReturnType<typeof setInterval> | undefined;

  /// @param say      makes one try, by the socket and by HTTP; returns whether the station confirmed it
  /// @param changed  called when the progress has changed
  constructor(
    private readonly say: (atOnce: boolean) => Promise<boolean>,
    private readonly changed: () => void,
  ) {}

  get progress(): StopProgress {
    return this.now;
  }

  private get open(): boolean {
    return this.now === "sent" || this.now === "owed";
  }

  /// @param known  the newest State, if there is a valid one
  press(known: State | undefined): void {
    ++this.newest;
    this.stopsThen = known?.stops ?? -1n;
    this.enter(this.now === "owed" ? "owed" : "sent");
    clearInterval(this.again);
    this.again = setInterval(() => {
      this.enter("owed");
      void this.attempt(true);
    }, kStopAgainMs);
    void this.attempt(false);
  }

  /// Handles a new connection: an owed stop is sent there first. Each State of the connection is newer than the press.
  welcomed(): void {
    if (!this.open) return;
    this.stopsThen = -1n;
    void this.attempt(true);
  }

  /// Takes the newest State of the station; undefined: none is known.
  heard(known: State | undefined): void {
    if (!known) return;
    if (this.open && known.heldStopped && known.stops > this.stopsThen) this.enter("confirmed");
    else if (this.now === "confirmed" && !known.heldStopped) this.enter("none");
  }

  private async attempt(atOnce: boolean): Promise<void> {
    const order = this.newest;
    const confirmed = await this.say(atOnce).catch(() => false);
    if (order !== this.newest || !this.open) return; // of an earlier press, or done already
    this.enter(confirmed ? "confirmed" : "owed");
  }

  private enter(progress: StopProgress): void {
    if (progress !== "sent" && progress !== "owed") {
      clearInterval(this.again);
      this.again = undefined;
    }
    if (progress === this.now) return;
    this.now = progress;
    this.changed();
  }
}
