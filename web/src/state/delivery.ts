// SPDX-License-Identifier: Apache-2.0
// How pictures arrive: their rate, those that are missing, and how much later than the fastest ones they come.
import type { Tick } from "../gen/phalanx/tick_pb";

const kPerSecond = 60; // pictures that the station sends
const kWindow = 10; // [s] that the figures speak of

/// Figures of the last 10 s.
export interface DeliveryFigures {
  readonly perSecond: number; // received
  readonly missing: number; // pictures of the station that did not come
  readonly delay: { readonly p50: number; readonly p99: number }; // beyond that of the fastest picture [s]; NaN: nothing came
}

export class Delivery {
  // On the station's clock and on the page's [s]. follows: the one before came from the same station, which was at work in between.
  private readonly came: { readonly time: number; readonly at: number; readonly follows: boolean }[] = [];
  private step = 0n; // of the newest picture
  private rested = false; // since then

  /// The station sends no pictures now, for example while it changes: the time until the next one is no gap.
  rest(): void {
    this.rested = true;
  }

  /// @param at  of its arrival, on the page's clock [s]
  feed(tick: Tick, at: number): void {
    const last = this.came.at(-1);
    if (last && tick.time < last.time) this.came.length = 0; // another station, whose clock begins elsewhere
    if (last && tick.time === last.time) return;
    this.came.push({ time: tick.time, at, follows: !this.rested && tick.tick >= this.step });
    this.step = tick.tick;
    this.rested = false;
    while (this.came[0]!.at < at - kWindow) this.came.shift();
  }

  figures(at: number): DeliveryFigures {
    const recent = this.came.filter((one) => one.at >= at - kWindow);
    const first = recent[0];
    if (!first) return { perSecond: 0, missing: 0, delay: { p50: NaN, p99: NaN } };
    const late = recent.map((one) => one.at - one.time).sort((a, b) => a - b);
    const quantile = (share: number) => late[Math.min(late.length - 1, Math.floor(share * late.length))]! - late[0]!;
    const gapBefore = ({ time, follows }: (typeof recent)[number], i: number) =>
      follows ? Math.max(0, Math.round((time - recent[i]!.time) * kPerSecond) - 1) : 0;
    const gaps = recent.slice(1).map(gapBefore);
    return {
      perSecond: recent.length / Math.max(1, at - first.at),
      missing: gaps.reduce((sum, gap) => sum + gap, 0),
      delay: { p50: quantile(0.5), p99: quantile(0.99) },
    };
  }
}
