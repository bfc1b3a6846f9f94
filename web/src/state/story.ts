// SPDX-License-Identifier: Apache-2.0
// The papers' result in four steps, which tick themselves: a stiffer wall, the hand shakes, smoothing, the hand settles.
import type { Verdict } from "./verdict";

export const kStorySteps = 4;
export const kStoryStiffness = 2.2; // [N/mm], docs/scenes.md
const kSettledSeconds = 1; // of contact without an oscillation

/// What a step depends on.
export interface StoryInput {
  readonly stiffness: number; // [N/mm]
  readonly smoothing: boolean;
  readonly verdict: Verdict["kind"];
  readonly now: number; // [s]
}

export class Story {
  private reached = 0; // steps that are done
  private steadySince = NaN; // [s]

  /// @returns the number of steps that are done
  feed({ stiffness, smoothing, verdict, now }: StoryInput): number {
    const stiff = stiffness >= kStoryStiffness - 1e-6;
    if (this.reached <= 1) this.reached = stiff ? 1 : 0;
    if (this.reached === 1 && verdict === "shakes") this.reached = 2;
    if (this.reached === 2 && smoothing) this.reached = 3;
    if (this.reached === 3 && !smoothing) this.reached = 2;
    if (this.reached < 3 || verdict === "shakes") this.steadySince = NaN;
    else if (verdict === "steady" && Number.isNaN(this.steadySince)) this.steadySince = now;
    if (this.reached === 3 && verdict === "steady" && now - this.steadySince >= kSettledSeconds) this.reached = kStorySteps;
    return this.reached;
  }

  restart(): void {
    this.reached = 0;
    this.steadySince = NaN;
  }
}
