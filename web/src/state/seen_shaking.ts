// SPDX-License-Identifier: Apache-2.0
// The least stiffness at which a force was seen to oscillate. It is what this page has observed, not a bound: a softer wall may shake, too.
import type { State } from "../gen/phalanx/cockpit_pb";
import type { Tick } from "../gen/phalanx/tick_pb";

const kNewtonPerMetre = 1000; // in a newton per millimetre
/// A change takes up to 0.2 s to come into force, State up to 0.5 s to tell of it, and the verdict is held for 0.5 s [s].
const kSettled = 1.5;
const kLasting = 1; // so long a force has oscillated with the same values before it counts [s]
const kStiffness = "force.stiffness_n_per_mm";

export class SeenShaking {
  private readonly least = new Map<string, number>(); // [N/m], by all that it depends on
  private known: State | undefined; // `key` is of this
  private key = "";
  private now = { key: "", stiffness: NaN, since: NaN, shaking: NaN }; // times on the ticks' clock [s]

  /// Takes every tick. @returns whether from() may have changed
  feed(tick: Tick, state: State | undefined): boolean {
    if (!state || !(tick.stiffness > 0)) return false;
    const key = this.keyOf(state);
    const { now } = this;
    if (key !== now.key || tick.stiffness !== now.stiffness || !(tick.time >= now.since)) {
      this.now = { key, stiffness: tick.stiffness, since: tick.time, shaking: NaN };
      return false;
    }
    if (tick.time - now.since < kSettled) return false;
    if (!tick.contact.some((contact) => contact.oscillating)) {
      now.shaking = NaN;
      return false;
    }
    if (Number.isNaN(now.shaking)) now.shaking = tick.time;
    if (tick.time - now.shaking < kLasting || tick.stiffness >= (this.least.get(key) ?? Infinity)) return false;
    this.least.set(key, tick.stiffness);
    return true;
  }

  /// @returns the least stiffness with this device and these settings [N/mm]; NaN: it was not seen to shake
  from(state: State | undefined): number {
    return state ? (this.least.get(this.keyOf(state)) ?? NaN) / kNewtonPerMetre : NaN;
  }

  /// All that decides whether a wall of a certain stiffness shakes, but for the hand that presses on it.
  private keyOf(state: State): string {
    if (state !== this.known) {
      this.known = state;
      const values = state.value.filter(({ key }) => key !== kStiffness && !key.startsWith("motion.")).map(({ key, value }) => `${key}=${value}`);
      this.key = [state.deviceSerial, state.deviceSpec, state.scene, ...values].join("\n");
    }
    return this.key;
  }
}
