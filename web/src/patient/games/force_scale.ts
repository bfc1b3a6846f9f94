// SPDX-License-Identifier: Apache-2.0
// The scale of a force on the page: from none to somewhat above the largest target.
import type { ExerciseNow } from "../game";

const kSwing = 0.5; // of a moving target around its mean, as in docs/exercises.md
const kAbove = 1.35; // of the largest target

/// @returns the force at the upper end [N]: never below the one before, so that the scale rests while a target moves
export function forceTop(before: number, { measure, target }: ExerciseNow): number {
  if (target.kind !== "force" || !(target.high > 0)) return before;
  const mean = (target.low + target.high) / 2;
  const half = (target.high - target.low) / 2;
  const first = before <= 1 && measure === "force_tracking"; // a moving target begins at its mean
  return Math.max(before, kAbove * (first ? (1 + kSwing) * mean + half : target.high));
}

/// Share of a band that a force has reached: 1 in it, falling to 0 over half of its distance from zero.
export function nearness(value: number, low: number, high: number): number {
  if (value >= low && value <= high) return 1;
  const away = value < low ? low - value : value - high;
  return Math.max(0, 1 - away / Math.max(1e-6, 0.5 * low));
}
