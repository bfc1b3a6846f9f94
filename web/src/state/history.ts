// SPDX-License-Identifier: Apache-2.0

const kSamplesPerSecond = 60; // that the station sends

/// Samples of so many seconds, with some room for the time after the last ones.
export const capacityFor = (seconds: number) => Math.ceil(1.1 * seconds * kSamplesPerSecond);

/// The last seconds of all channels, in storage made once. Each sample is written twice, a capacity apart, so that the last ones
/// always lie in one piece and are read without copying.
export class History {
  readonly times: Float64Array;
  private readonly values: readonly Float32Array[];
  private head = 0; // where the next sample goes, 0 .. capacity - 1
  private filled = 0;

  constructor(
    readonly channelCount: number,
    readonly capacity: number,
  ) {
    this.times = new Float64Array(2 * capacity);
    this.values = Array.from({ length: channelCount }, () => new Float32Array(2 * capacity));
  }

  get length(): number {
    return this.filled;
  }

  /// A time that is not after the last one begins a new history: the station's clock has restarted.
  push(time: number, row: ArrayLike<number>): void {
    if (this.filled > 0) {
      const last = this.times[this.head + this.capacity - 1]!;
      if (time === last) return;
      if (!(time > last)) this.clear();
    }
    const at = this.head;
    const twin = at + this.capacity;
    this.times[at] = this.times[twin] = time;
    for (let channel = 0; channel < this.channelCount; ++channel) {
      const values = this.values[channel]!;
      values[at] = values[twin] = row[channel] ?? NaN;
    }
    this.head = (at + 1) % this.capacity;
    this.filled = Math.min(this.filled + 1, this.capacity);
  }

  clear(): void {
    this.filled = 0;
    this.head = 0;
  }

  /// Newest sample's time; NaN if there is none.
  get end(): number {
    return this.filled > 0 ? this.times[this.head + this.capacity - 1]! : NaN;
  }

  private get first(): number {
    return this.head + this.capacity - this.filled;
  }

  /// Times, oldest first; a view that the next push changes.
  time(): Float64Array {
    return this.times.subarray(this.first, this.first + this.filled);
  }

  /// One channel's values beside time(); likewise.
  channel(channel: number): Float32Array {
    const values = this.values[channel];
    if (!values) throw new RangeError(`there is no channel ${channel}`);
    return values.subarray(this.first, this.first + this.filled);
  }

  /// Place in time() of the first sample at this time or later; `length`: there is none.
  firstFrom(time: number): number {
    let [low, high] = [0, this.filled];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[this.first + middle]! < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /// Place in time() of the sample nearest to this time; -1: the history is empty.
  nearest(time: number): number {
    const after = this.firstFrom(time);
    if (after === 0) return this.filled > 0 ? 0 : -1;
    if (after === this.filled) return after - 1;
    const at = this.first + after;
    return time - this.times[at - 1]! < this.times[at]! - time ? after - 1 : after;
  }
}
