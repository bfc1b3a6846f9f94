// SPDX-License-Identifier: Apache-2.0
// The least stiffness at which a force was seen to oscillate. It is what this page has observed, not a bound: a softer wall may shake, too.
import type { State, Welcome } from "../gen/phalanx/cockpit_pb";
import type { Tick } from "../gen/phalanx/tick_pb";
import { valueOf } from "./keys";

const kNewtonPerMetre = 1000; // in a newton per millimetre

/// Everything that decides whether a wall of a certain stiffness shakes, as far as a page knows it.
const kSettings = ["stabiliser.method", "smoothing.max_n_per_s", "smoothing.min_n_per_s", "force.law", "rate_hz"];

export class SeenShaking {
  private readonly least = new Map<string, number>(); // [N/m], by device and settings

  feed(tick: Tick, state: State | undefined, welcome: Welcome | undefined): void {
    if (!state || !(tick.stiffness > 0) || !tick.contact.some((contact) => contact.oscillating)) return;
    const key = keyOf(state, welcome);
    this.least.set(key, Math.min(tick.stiffness, this.least.get(key) ?? Infinity));
  }

  /// @returns the least stiffness with this device and these settings [N/mm]; NaN: it was not seen to shake
  from(state: State | undefined, welcome: Welcome | undefined): number {
    return state ? (this.least.get(keyOf(state, welcome)) ?? NaN) / kNewtonPerMetre : NaN;
  }
}

function keyOf(state: State, welcome: Welcome | undefined): string {
  return [state.deviceSerial, state.deviceSpec, state.scene, ...kSettings.map((setting) => valueOf(state, welcome, setting))].join("\n");
}
