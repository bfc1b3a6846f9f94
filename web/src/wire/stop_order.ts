// SPDX-License-Identifier: Apache-2.0
// A stop that somebody said on this page, until the station has confirmed it: it is owed, and said again and again.
import type { State } from "../gen/phalanx/cockpit_pb";

/// none: nobody said it; sent: on its way; owed: not confirmed, said again; confirmed: the station has it.
export type StopProgress = "none" | "sent" | "owed" | "confirmed";

/// An owed stop is said again so often [ms].
export const kStopAgainMs = 1000;

export class StopOrder {
  private now: StopProgress = "none";
  private newest = 0; // number of the newest press
  private stopsThen = -1n; // State.stops when it was pressed; -1: anything newer counts
  private again: ReturnType<typeof setInterval> | undefined;

  /// @param say      one try, by the socket and by HTTP; whether the station confirmed it
  /// @param changed  the progress is another one
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

  /// @param known  the newest State, where there is one that is worth something
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

  /// A new connection: what is owed is said there first. Whatever it then says of a stop is newer than the press.
  welcomed(): void {
    if (!this.open) return;
    this.stopsThen = -1n;
    void this.attempt(true);
  }

  /// What the station is known to be doing; undefined: nothing.
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
