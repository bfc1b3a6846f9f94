// SPDX-License-Identifier: Apache-2.0
// What the patient says: pain and tiredness from 0 to 10, each at a place of its own, and the answers to a question. A question that has just
// changed takes no press for a while: the second one of a double tap was meant for the question before.
import { button, el, setAttribute, setShown } from "../panels/dom";
import { choiceText } from "../patient/goal";
import type { ExerciseNow } from "./exercise_now";
import { exerciseTexts, words } from "./words";

const kRatings = Array.from({ length: 11 }, (_, value) => value);
const kQuestionMs = 800;

/// A while in which presses are not taken.
export class Hold {
  private until = 0; // [ms]

  /// @param time  [ms]
  constructor(
    private readonly time: () => number,
    private readonly ms: number,
  ) {}

  begin(): void {
    this.until = this.time() + this.ms;
  }
  get holds(): boolean {
    return this.time() < this.until;
  }
}

/// What the scales show of an exercise.
type Asked = Pick<ExerciseNow, "asks" | "stage" | "choices">;

export class RatingScales {
  /// Opens both scales: the patient has said something without being asked.
  readonly says: HTMLButtonElement;
  readonly choices = el("div", { class: "buttons run-choices", role: "group", "aria-label": words.run.phases["answer"] });
  readonly pain = this.scale("pain", words.run.pain);
  readonly fatigue = this.scale("fatigue", words.run.fatigue);
  private readonly hold: Hold;
  private open = false;
  private shownChoices = "";
  private newest: Asked = { asks: "", stage: "none", choices: [] };

  /// @param send  gets each answer with its kind: "pain", "fatigue" or "answer"  @param time  [ms]
  constructor(
    private readonly send: (kind: string, value: number) => void,
    time: () => number,
  ) {
    this.hold = new Hold(time, kQuestionMs);
    this.says = button(words.run.says, () => this.setOpen(!this.open), { "aria-expanded": "false" });
  }

  show(now: Asked): void {
    const { asks, stage } = now;
    if (asks !== this.newest.asks) this.hold.begin();
    this.newest = now;
    this.showChoices(stage === "running" ? now.choices : []);
    setShown(this.says, stage === "running");
    for (const [element, kind] of [[this.pain, "pain"], [this.fatigue, "fatigue"]] as const) {
      setShown(element, asks === kind || this.open);
      setAttribute(element, "data-asked", String(asks === kind));
    }
    for (const one of [this.pain, this.fatigue, this.choices]) setAttribute(one, "data-settling", String(this.hold.holds));
  }

  private showChoices(choices: readonly string[]): void {
    const wanted = choices.join("\n");
    setShown(this.choices, wanted !== "");
    if (wanted === this.shownChoices) return;
    this.shownChoices = wanted;
    this.hold.begin();
    this.choices.replaceChildren(...choices.map((text, i) => button(choiceText(text, exerciseTexts), () => this.answer("answer", i + 1), { class: "run-choice" })));
  }

  private setOpen(open: boolean): void {
    this.open = open;
    setAttribute(this.says, "aria-expanded", String(open));
    this.show(this.newest);
  }

  private scale(kind: "pain" | "fatigue", label: string): HTMLElement {
    return el(
      "div",
      { class: "run-ratings", role: "group", "aria-label": label, hidden: true },
      el("span", { class: "quiet-text" }, label),
      el("div", { class: "run-scale" }, ...kRatings.map((value) => button(String(value), () => this.answer(kind, value)))),
    );
  }

  private answer(kind: string, value: number): void {
    if (this.hold.holds) return;
    this.hold.begin();
    this.setOpen(false);
    this.send(kind, value);
  }
}
