// SPDX-License-Identifier: Apache-2.0
// How an exercise goes, without whose it is and without buttons: phase and time, what the patient is told, goal, forces, and whether forces are
// off. The panel of the therapist has it, and so has the page while it is locked.
import { el, setAttribute, setShown, setText } from "../panels/dom";
import { instructionText } from "../patient/goal";
import { language } from "../strings";
import type { ExerciseNow, FaultWords } from "./exercise_now";
import { ForceBars, GoalBar } from "./goal_bar";
import { exerciseTexts, faultLanguages, stationLanguage, words } from "./words";

const second = /^Let go\. The second/; // of two sponges; the station's words

/// Where it is: the trial, or the phase between trials.
export function phaseText({ phase, trial, trials }: ExerciseNow): string {
  const name = words.run.phases[phase] ?? phase;
  if (trial === 0) return name;
  const counted = words.run.trial(String(trial), String(trials));
  return phase === "trial" ? counted : `${name} · ${counted}`;
}

/// What is to be done now. In a trial and an answer it is the sentence of the patient's screen.
export function toldText(now: ExerciseNow): string {
  const { phase, asks, measure, instruction, target } = now;
  const { told } = words.run;
  switch (phase) {
    case "ready":
      return told.ready;
    case "warm_up":
      return exerciseTexts.warmUp;
    case "rating":
      return asks === "fatigue" ? told.fatigue : told.pain;
    case "rest":
      return second.test(instruction) ? exerciseTexts.second : told.rest;
    case "trial":
      return instruction === "" ? "" : instructionText({ instruction, measure, target: { kind: target } }, exerciseTexts);
    case "answer":
      return measure === "feel_and_find" ? exerciseTexts.softer : exerciseTexts.which;
    case "paused":
      return told.paused;
    case "done":
      return "";
  }
}

export class RunningView {
  private readonly texts = words.run;
  private readonly phase = el("p", { class: "run-phase", role: "status" });
  private readonly instruction = el("p", { class: "run-instruction" });
  private readonly left = el("span", { class: "figure run-left" });
  private readonly progress = el("progress", { max: 1, value: 0, "aria-label": words.run.pending });
  private readonly noted = el("p", { class: "hint", lang: stationLanguage });
  private readonly offHint: HTMLElement;
  private readonly fault = el("span", { class: "run-fault", hidden: true });
  private readonly goal = new GoalBar();
  private readonly bars = new ForceBars();
  /// Takes the focus when the button that had it is gone: Tab goes on from here.
  readonly now = el("div", { class: "run-now", role: "group", "aria-label": words.run.now, tabindex: -1 }, this.phase, this.left, this.progress, this.instruction, this.noted);
  readonly off = el("div", { class: "run-off", role: "alert", hidden: true }, el("strong", {}, words.run.forcesOff));
  readonly goalElement = this.goal.element;
  readonly forces = this.bars.element;

  /// @param paused  what is to be done in a pause  @param off  how forces are turned on again
  constructor(
    private readonly paused: string = words.run.told.paused,
    off: string = words.run.forcesOffHint,
  ) {
    this.offHint = el("span", {}, off);
    this.off.append(this.fault, this.offHint);
  }

  /// What the fault means and its remedy, in the page's language where it is known.
  private showFault(fault: FaultWords | undefined): void {
    const own = fault && faultLanguages[language.code]?.[fault.name];
    setText(this.fault, own ?? (fault ? `${fault.meaning} ${fault.remedy}` : ""));
    setAttribute(this.fault, "lang", own === undefined ? stationLanguage : null);
    setShown(this.fault, fault !== undefined);
  }

  show(now: ExerciseNow): void {
    const { phase, stage } = now;
    const runs = stage === "running";
    const counts = now.training && now.counted > 0 ? [this.texts.successes(String(now.successes), String(now.counted))] : [];
    const at = runs ? [phaseText(now), ...counts].join(" · ") : (this.texts.stages[stage] ?? stage);
    setText(this.phase, at);
    const told = !runs ? "" : phase === "paused" ? this.paused : toldText(now);
    setText(this.instruction, told);
    setShown(this.instruction, told !== "");
    setText(this.noted, now.note);
    setShown(this.noted, runs && now.note !== "");
    const between = phase === "ready" || phase === "paused" || phase === "done";
    setText(this.left, runs && now.remaining > 0 && phase !== "paused" ? this.texts.left(String(Math.ceil(now.remaining))) : "");
    setShown(this.progress, runs && !between);
    this.progress.value = now.progress;
    setAttribute(this.progress, "aria-label", at);
    setShown(this.off, runs && now.forcesOff && phase !== "ready" && phase !== "done");
    setShown(this.offHint, phase === "paused");
    this.showFault(now.fault);
    this.goal.show(now);
    setShown(this.goal.element, runs && (phase === "trial" || now.value !== undefined));
    this.bars.show(now);
    setShown(this.bars.element, runs);
  }
}

/// Keeps the focus in sight: if what has it is not displayed any longer, `next` gets it. No button does, since a key that is held down would
/// press it.
export function keepFocus(within: HTMLElement, next: HTMLElement): void {
  const { activeElement } = document;
  if (activeElement instanceof HTMLElement && within.contains(activeElement) && activeElement.closest("[hidden]")) next.focus();
}
