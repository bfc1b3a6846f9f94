// SPDX-License-Identifier: Apache-2.0
// A practice without words before the first trial: the drawn hand shows the movement, then mirrors the patient's own until it matches once.
import type { ExerciseNow } from "./game";

export type PracticeStep = "none" | "watch" | "try" | "understood";

const kWatch = 6; // time of the demonstration [s]
const kPraise = 2.5; // time for which the success is displayed [s]
const kOpen = 0.25; // shares of flexion
const kClosed = 0.55;
const kMoved = 0.3; // difference of one digit to where it was that is a movement
const kTouch = 0.02; // distance of pads [m]
const kPress = 0.4; // [N]
const watchedOnly = new Set(["feel_and_find", "object_in_hand"]); // the own hand is never shown there

const largest = (values: readonly number[]) => values.reduce((most, value) => Math.max(most, value), 0);
const mean = (values: readonly number[]) => (values.length === 0 ? 0 : values.reduce((sum, value) => sum + value, 0) / values.length);

/// Whether the patient does now what the exercise is about: its first half, and then its second half.
function matches(now: ExerciseNow, half: "first" | "second", start: readonly number[]): boolean {
  const { flexion, force, padDistance } = now;
  const first = half === "first";
  switch (now.measure) {
    case "press_and_hold":
    case "force_tracking":
    case "squeeze_release":
    case "pinch":
    case "own_force":
      if (force.length > 0 && (force.some((one) => one > kPress) || !first)) return first === force.some((one) => one > kPress);
      return first && flexion.some((value, i) => value - (start[i] ?? value) > kMoved);
    case "opposition":
      return padDistance.length > 0 && first === padDistance.some((distance) => distance < kTouch);
    case "independence":
    case "smoothness": {
      const moved = largest(flexion.map((value, i) => Math.abs(value - (start[i] ?? value)))) > kMoved;
      return first === moved;
    }
    default:
      return first ? mean(flexion) > kClosed : mean(flexion) < kOpen;
  }
}

/// Feed it each frame; it says what the screen should show. It belongs to one exercise.
export class Practice {
  step: PracticeStep = "none";
  private number = 0;
  private time = 0;
  private start: readonly number[] = [];
  private half: "first" | "second" = "first";
  private understood = false;

  /// @param wanted  aphasia mode  @param dt  [s]
  take(now: ExerciseNow, wanted: boolean, dt: number): PracticeStep {
    if (now.number !== this.number) Object.assign(this, { step: "none", number: now.number, time: 0, half: "first", understood: false });
    const before = now.stage === "running" && (now.phase === "warm_up" || (now.phase === "rest" && now.trial <= 1));
    if (!wanted || !before || (this.understood && this.step === "none")) return (this.step = "none");
    this.time += dt;
    if (this.step === "none") this.enter("watch", now);
    else if (this.step === "watch" && this.time > kWatch) {
      this.understood = watchedOnly.has(now.measure);
      this.enter(this.understood ? "none" : "try", now);
    }
    else if (this.step === "try" && matches(now, this.half, this.start)) {
      if (this.half === "first") this.half = "second";
      else this.enter("understood", now);
    } else if (this.step === "understood" && this.time > kPraise) this.enter("none", now);
    return this.step;
  }

  private enter(step: PracticeStep, now: ExerciseNow): void {
    this.step = step;
    this.time = 0;
    this.start = now.flexion;
    if (step === "understood") this.understood = true;
  }
}
