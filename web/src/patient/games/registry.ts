// SPDX-License-Identifier: Apache-2.0
// Which game shows which exercise.
import type { ExerciseNow, MakeGame } from "../game";
import { makeFeel } from "./feel_and_find";
import { makeMelody } from "./melody";
import { makeBalloon, makeFountain, makePinch } from "./press";
import { makeFlower } from "./range";
import { makeReach } from "./reach_line";
import { river } from "./river";

const games: Readonly<Record<string, MakeGame>> = {
  press_and_hold: makeBalloon,
  force_tracking: makeBalloon,
  squeeze_release: makeFountain,
  own_force: makeFountain,
  pinch: makePinch,
  range_of_motion: makeFlower,
  total_active_motion: makeFlower,
  entry_check: makeFlower,
  smoothness: makeReach,
  opposition: makeMelody,
  independence: makeMelody,
  feel_and_find: makeFeel,
  object_in_hand: makeFeel,
};
const rivers = new Set(["force_tracking", "press_and_hold", "squeeze_release"]);

/// A training of forces is River; an assessment of them is a goal alone. @returns undefined: there is none, words alone are shown
export function gameFor({ measure, training }: Pick<ExerciseNow, "measure" | "training">): MakeGame | undefined {
  return training && rivers.has(measure) ? river : games[measure];
}
