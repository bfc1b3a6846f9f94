// SPDX-License-Identifier: Apache-2.0
// One line above the patients while an exercise is under way and something else is displayed: whose it is, how far it is, and the way to it.
import { button, el, setShown, setText } from "../panels/dom";
import type { ExerciseNow } from "./exercise_now";
import { phaseText } from "./running_view";
import { titleText, words } from "./words";

export class RunningStrip {
  private readonly what = el("strong", {});
  private readonly state = el("span", { class: "quiet-text" });
  private readonly stale = el("span", { class: "refused", role: "alert", hidden: true }, words.run.stale);
  readonly element: HTMLElement;

  /// @param open  shows the exercise
  constructor(open: () => void) {
    this.element = el("div", { class: "people-box people-strip", hidden: true }, this.what, this.state, this.stale, button(words.run.show, open, { class: "primary" }));
  }

  /// @param stale  the station has not answered for a while
  setStale(stale: boolean): void {
    setShown(this.stale, stale);
    setShown(this.state, !stale);
  }

  /// @param now  absent: there is nothing to lead to
  show(now: ExerciseNow | undefined): void {
    setShown(this.element, now !== undefined);
    if (!now) {
      setText(this.what, "");
      setText(this.state, "");
      return;
    }
    setText(this.what, words.run.strip(now.code, titleText(now)));
    setText(this.state, now.stage === "running" ? phaseText(now) : (words.run.stages[now.stage] ?? now.stage));
  }
}
