// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { ChangeWatch } from "../../../src/patient/changes";
import { exerciseNow } from "./exercise";

it("trials begin and end once, and a success is one that was counted", () => {
  const watch = new ChangeWatch();
  expect(watch.take(exerciseNow({ phase: "rest" }))).toMatchObject({ began: true, trialBegan: false, succeeded: false });
  const trial = exerciseNow();
  expect(watch.take(trial)).toMatchObject({ began: false, phase: true, trialBegan: true, trialEnded: false });
  expect(watch.take(trial)).toMatchObject({ phase: false, trialBegan: false });
  expect(watch.take(exerciseNow({ progress: 0.5 }))).toMatchObject({ trialBegan: false, trialEnded: false });
  expect(watch.take(exerciseNow({ phase: "rest", trial: 2, counted: 1, lastSuccess: true }))).toMatchObject({ trialEnded: true, succeeded: true });
  expect(watch.take(exerciseNow({ phase: "rest", trial: 2, counted: 1, lastSuccess: true, progress: 0.5 }))).toMatchObject({ succeeded: false });
});

it("an exercise that a page joins in the middle has no success that this page saw", () => {
  expect(new ChangeWatch().take(exerciseNow({ counted: 7, lastSuccess: true }))).toMatchObject({ began: true, succeeded: false });
});
