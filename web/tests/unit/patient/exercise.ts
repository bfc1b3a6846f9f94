// SPDX-License-Identifier: Apache-2.0
// Exercises for tests of the patient's screen.
import type { ExerciseNow, Target } from "../../../src/patient/game";
import { noTarget, nothingKnown, type Known } from "../../../src/patient/state";

export function exerciseNow(changes: Partial<ExerciseNow> = {}, target: Partial<Target> = {}): ExerciseNow {
  return {
    number: 1, name: "train_tracking", title: "", measure: "force_tracking", training: true, symbol: "boat", side: "right", simulated: false, stage: "running",
    phase: "trial", instruction: "Keep the bar on the moving target.", note: "", trial: 1, trials: 20, progress: 0, remaining: 10, target: { ...noTarget, ...target },
    value: undefined, valueUnit: "", choices: [], asks: undefined, hidesScene: false, successes: 0, counted: 0, lastSuccess: false, force: [0, 0, 0, 0, 0],
    touching: [false, false, false, false, false], flexion: [0, 0, 0, 0, 0], padDistance: [0.07, 0.07, 0.07, 0.07], forcesOff: false, trouble: "", ...changes,
  };
}

export const knownWith = (exercise: ExerciseNow | undefined, changes: Partial<Known> = {}): Known => ({ ...nothingKnown, connected: "open", ever: true, exercise, ...changes });
