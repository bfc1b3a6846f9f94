// SPDX-License-Identifier: Apache-2.0
// The stability verdict as a light: whether the hand touches, and whether its force shakes.
import type { Tick } from "../gen/phalanx/tick_pb";

export type Verdict =
  | { readonly kind: "none" } // no contact
  | { readonly kind: "off" } // it touches, but nothing is sent to the motors
  | { readonly kind: "steady" }
  | { readonly kind: "shakes"; readonly frequency: number; readonly swing: number }; // [Hz], [N]

export const verdictKinds: readonly Verdict["kind"][] = ["none", "off", "steady", "shakes"];

const kOscillating = 1 << 13; // Status::kOscillating
/// Shaking is shown at least so long, so that it is seen [s].
export const kHoldSeconds = 0.5;

/// Of one tick alone. Where several segments shake, the widest swing speaks.
export function verdictOf(tick: Tick): Verdict {
  let worst: { frequency: number; swing: number } | undefined;
  for (const contact of tick.contact) {
    if (contact.oscillating && (!worst || contact.swing > worst.swing)) {
      worst = { frequency: contact.frequency, swing: contact.swing };
    }
  }
  if (worst) return { kind: "shakes", ...worst };
  if ((tick.status & kOscillating) !== 0) return { kind: "shakes", frequency: NaN, swing: NaN };
  if (!tick.contact.some((contact) => contact.touching)) return { kind: "none" };
  return { kind: tick.atRest || tick.factor === 0 ? "off" : "steady" };
}

export class VerdictLight {
  private shaking: Verdict = { kind: "none" };
  private heldUntil = -Infinity;
  private current: Verdict = { kind: "none" };

  /// @param now  the page's clock [s]
  feed(tick: Tick, now: number): Verdict {
    const verdict = verdictOf(tick);
    if (verdict.kind === "shakes") {
      const known = Number.isFinite(verdict.frequency) || this.shaking.kind !== "shakes" || now >= this.heldUntil;
      if (known) this.shaking = verdict;
      this.heldUntil = now + kHoldSeconds;
    }
    this.current = now < this.heldUntil ? this.shaking : verdict;
    return this.current;
  }

  get shown(): Verdict {
    return this.current;
  }
}
