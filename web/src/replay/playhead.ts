// SPDX-License-Identifier: Apache-2.0

export const speeds: readonly number[] = [0.1, 0.25, 0.5, 1, 2, 4];
const kLongestFrame = 0.25; // [s]: a page that slept goes on where it was

/// The displayed moment of a recording, which moves on while it plays.
export class Playhead {
  private at = 0;
  private runs = false;
  private rate = 1;
  private last: number | undefined; // time of the last frame [ms]

  /// @param length  of the recording [s]
  /// @param changed  called when it plays, stands or goes at another speed
  constructor(
    readonly length: number,
    private readonly changed: () => void = () => {},
  ) {}

  get position(): number {
    return this.at;
  }

  get playing(): boolean {
    return this.runs;
  }

  get speed(): number {
    return this.rate;
  }

  /// At the end it begins again.
  play(): void {
    if (this.at >= this.length) this.at = 0;
    this.runs = true;
    this.last = undefined;
    this.changed();
  }

  pause(): void {
    this.runs = false;
    this.changed();
  }

  seek(time: number): void {
    this.at = Math.min(this.length, Math.max(0, Number.isFinite(time) ? time : 0));
  }

  setSpeed(speed: number): void {
    this.rate = speed;
    this.changed();
  }

  faster(steps: number): void {
    const at = speeds.indexOf(this.rate) + steps;
    const next = speeds[Math.min(speeds.length - 1, Math.max(0, at))];
    if (next !== undefined) this.setSpeed(next);
  }

  /// Moves on. @param now  time of this frame [ms]
  /// @param held  what comes next is not loaded: it waits
  frame(now: number, held = false): void {
    const passed = this.last === undefined ? 0 : Math.min(kLongestFrame, (now - this.last) / 1000);
    this.last = now;
    if (!this.runs || held) return;
    this.at = Math.min(this.length, this.at + passed * this.rate);
    if (this.at >= this.length) this.pause();
  }
}
