// SPDX-License-Identifier: Apache-2.0
// What happened between two messages of an exercise.
import type { ExerciseNow } from "./game";

export interface Changes {
  readonly began: boolean; // another exercise
  readonly phase: boolean; // another phase, or another exercise
  readonly trialBegan: boolean;
  readonly trialEnded: boolean;
  readonly succeeded: boolean; // a trial of a training was counted as successful
}

const kNothing: Changes = { began: false, phase: false, trialBegan: false, trialEnded: false, succeeded: false };

/// Compares each exercise with the one before.
export class ChangeWatch {
  private last: ExerciseNow | undefined;

  take(now: ExerciseNow): Changes {
    const { last } = this;
    this.last = now;
    if (last === now) return kNothing;
    const began = last === undefined || last.number !== now.number;
    const tried = !began && last.phase === "trial";
    const other = began || last.trial !== now.trial;
    return {
      began,
      phase: began || last.phase !== now.phase,
      trialBegan: now.phase === "trial" && (!tried || other),
      trialEnded: tried && (now.phase !== "trial" || other),
      succeeded: !began && now.counted > last.counted && now.lastSuccess,
    };
  }
}
