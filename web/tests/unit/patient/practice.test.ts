// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Practice } from "../../../src/patient/practice";
import type { ExerciseNow } from "../../../src/patient/game";
import { exerciseNow } from "./exercise";

const kStep = 0.05; // [s]
/// Steps for a time with one exercise. @returns the last answer
function during(practice: Practice, seconds: number, exercise: ExerciseNow): string {
  let step = "none";
  for (let t = 0; t < seconds; t += kStep) step = practice.take(exercise, true, kStep);
  return step;
}
const warm = (changes: Partial<ExerciseNow> = {}) => exerciseNow({ phase: "warm_up", measure: "range_of_motion", ...changes });
const open = warm({ flexion: [0.1, 0.1, 0.1, 0.1, 0.1] });
const closed = warm({ flexion: [0.7, 0.8, 0.8, 0.8, 0.7] });

describe("the practice", () => {
  it("shows the movement, waits for the patient's own, and praises it once", () => {
    const practice = new Practice();
    expect(during(practice, 1, open)).toBe("watch");
    expect(during(practice, 6, open)).toBe("try");
    expect(during(practice, 60, open), "no time limit").toBe("try");
    expect(during(practice, 0.5, closed)).toBe("try");
    expect(during(practice, 0.5, open)).toBe("understood");
    expect(during(practice, 5, open)).toBe("none");
    expect(during(practice, 20, open), "not a second time").toBe("none");
  });

  it("is none without aphasia mode, in a trial and in later rests", () => {
    const practice = new Practice();
    expect(practice.take(open, false, kStep)).toBe("none");
    expect(during(practice, 1, exerciseNow({ phase: "trial" }))).toBe("none");
    expect(during(practice, 1, exerciseNow({ phase: "rest", trial: 2 }))).toBe("none");
    expect(during(practice, 1, exerciseNow({ phase: "rest", trial: 1 }))).toBe("watch");
  });

  it("comes again with another exercise", () => {
    const practice = new Practice();
    during(practice, 8, open);
    during(practice, 1, closed);
    during(practice, 6, open);
    expect(practice.step).toBe("none");
    expect(during(practice, 1, warm({ number: 2 }))).toBe("watch");
  });

  it("only shows how to explore what is hidden: the own hand never appears", () => {
    for (const measure of ["feel_and_find", "object_in_hand"]) {
      const practice = new Practice();
      const hidden = warm({ measure, hidesScene: true });
      expect(during(practice, 1, hidden)).toBe("watch");
      expect(during(practice, 6, hidden)).toBe("none");
      expect(during(practice, 20, { ...hidden, flexion: [0.9, 0.9, 0.9, 0.9, 0.9] })).toBe("none");
    }
  });

  it("takes a squeeze and its release for forces", () => {
    const practice = new Practice();
    const press = (newtons: number) => warm({ measure: "press_and_hold", force: [0, newtons, 0, 0, 0] });
    expect(during(practice, 8, press(0))).toBe("try");
    expect(during(practice, 1, press(1.5))).toBe("try");
    expect(during(practice, 0.2, press(0))).toBe("understood");
  });
});
