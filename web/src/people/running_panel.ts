// SPDX-License-Identifier: Apache-2.0
// The exercise that runs, for the therapist: what the patient should do, how it goes, and the few buttons that it needs now. It is made once
// for an exercise and only changed afterwards, so that a button stays where a finger goes to. “Pause” and “Go on” are two buttons at two
// places: one that changed its meaning could turn the forces on when a patient has just paused.
import { button, el, setAttribute, setShown, setText } from "../panels/dom";
import { onPress } from "../panels/press";
import { isUnderWay, type ExerciseNow } from "./exercise_now";
import { endedView } from "./ended_view";
import { ForceBars, GoalBar } from "./goal_bar";
import { form } from "./form";
import { phaseText } from "./running_strip";
import { picture } from "./symbols";
import { refusalText } from "./trouble";
import { stationLanguage, words } from "./words";

export interface RunningActions {
  input(kind: string, values?: Readonly<Record<string, number>>): Promise<void>;
  note(text: string): Promise<void>;
  back(): void; // to the patient
  list(): void;
  again(): void;
}

const kRatings = Array.from({ length: 11 }, (_, value) => value);
const kDifficulties = [0, 0.25, 0.5, 0.75, 1] as const;
const kHundred = 100;
const kResumeMs = 1000; // after a pause “Go on” takes no press: the second one of a double tap is none
const kQuestionMs = 800; // after a question has changed its answers take no press, likewise

/// Address of the patient's screen in the language of this page.
export const screenAddress = (language: string): string => `patient.html?${new URLSearchParams({ lang: language }).toString()}`;

export class RunningPanel {
  private readonly texts = words.run;
  private readonly phase = el("p", { class: "run-phase", role: "status" });
  private readonly instruction = el("p", { class: "run-instruction", lang: stationLanguage });
  private readonly left = el("span", { class: "figure run-left" });
  private readonly progress = el("progress", { max: 1, value: 0, "aria-label": words.run.pending });
  private readonly noted = el("p", { class: "hint", lang: stationLanguage });
  private readonly stale = el("p", { class: "refused", role: "alert", hidden: true }, words.run.stale);
  private readonly trouble = el("p", { class: "refused", role: "alert", hidden: true });
  private readonly off = el("div", { class: "run-off", role: "alert", hidden: true });
  private readonly offHint = el("span", {}, words.run.forcesOffHint);
  private readonly refused = el("p", { class: "refused", role: "alert", hidden: true });
  private readonly goal = new GoalBar();
  private readonly forces = new ForceBars();
  private readonly start = this.send(words.run.start, "begin", { class: "primary run-main" });
  private readonly resume = this.send(words.run.resume, "resume", { class: "primary run-main" });
  private readonly pause = el("button", { type: "button", class: "run-main" }, words.run.pause);
  private readonly skip = this.send(words.run.skip, "skip");
  private readonly reset = this.send(words.run.reset, "reset");
  private readonly end = button(words.run.end, () => this.askEnd(true), { class: "quiet" });
  private readonly sure = el(
    "div",
    { class: "run-sure", role: "group", "aria-label": words.run.endSure, hidden: true },
    el("span", {}, words.run.endSure),
    this.send(words.run.endYes, "abort", { class: "primary" }),
    button(words.run.endNo, () => this.askEnd(false)),
  );
  private readonly pain = this.ratings("pain", words.run.pain);
  private readonly fatigue = this.ratings("fatigue", words.run.fatigue);
  private readonly choices = el("div", { class: "buttons run-choices", role: "group", "aria-label": words.run.phases["answer"] });
  private readonly difficulty: HTMLElement;
  private readonly says: HTMLElement;
  private readonly live: HTMLElement;
  private readonly result = el("div", { class: "run-result", hidden: true });
  private newest: ExerciseNow;
  private shownChoices = "";
  private saysOpen = false; // the ratings stand there though none was asked for
  private endedShown = false;
  private resumeFrom = 0; // time from which on “Go on” takes a press [ms]
  private answersFrom = 0; // likewise of ratings and choices
  private readonly noteText: HTMLTextAreaElement | null;
  readonly element: HTMLElement;

  constructor(
    readonly number: number,
    now: ExerciseNow,
    private readonly actions: RunningActions,
    language: string,
    private readonly time: () => number,
    draft: string,
  ) {
    for (const one of [this.resume, this.pause]) setShown(one, false); // each appears when its phase has come
    onPress(this.pause, () => {
      this.holdResume();
      this.give("pause");
    }); // when the button goes down
    const saysButton = button(words.run.says, () => {
      this.saysOpen = !this.saysOpen;
      setAttribute(saysButton, "aria-expanded", String(this.saysOpen));
      this.showRatings(this.newest);
    }, { "aria-expanded": "false" });
    this.says = saysButton;
    this.difficulty = el(
      "div",
      { class: "run-difficulty", role: "group", "aria-label": words.run.difficulty },
      el("span", { class: "quiet-text" }, words.run.difficulty),
      el("div", { class: "buttons" }, ...kDifficulties.map((value) => button(`${kHundred * value} %`, () => this.give("difficulty", value)))),
    );
    const noteSaved = el("p", { role: "status" });
    const writeNote = async (text: string) => {
      await actions.note(text);
      if (this.noteText) this.noteText.value = "";
      setText(noteSaved, words.run.noteDone);
    };
    const note = el("details", { open: draft !== "" }, el("summary", {}, words.run.note), form([{ name: "text", label: words.notes.text, kind: "area", longest: 4000 }], { text: draft }, words.save, (values) => writeNote(String(values["text"]))), noteSaved);
    this.noteText = note.querySelector("textarea");
    const links = el(
      "div",
      { class: "buttons run-links" },
      el("a", { href: screenAddress(language), target: "_blank", rel: "opener" }, this.texts.screen),
      el("a", { href: "./", target: "_blank", rel: "opener" }, this.texts.watch),
    );
    const main = el(
      "div",
      { class: "run-column" },
      el("div", { class: "run-now" }, this.phase, this.left, this.progress, this.instruction, this.noted),
      el("div", { class: "buttons run-buttons" }, el("div", { class: "run-go" }, this.start, this.resume), this.pause, this.skip, this.reset, this.says, this.end),
      this.sure,
      this.choices,
      this.pain,
      this.fatigue,
      this.off,
      this.goal.element,
    );
    this.live = el("div", { class: "run-live" }, main, el("div", { class: "run-column run-beside" }, this.forces.element, this.difficulty, note));
    this.off.append(el("strong", {}, words.run.forcesOff), this.offHint);
    const who = el(
      "header",
      { class: "patient-head" },
      picture(now.symbol),
      el("h2", { tabindex: -1 }, now.code),
      el("p", { class: "patient-who" }, `${words.begin.hand[now.side] ?? now.side}, ${words.symbols[now.symbol] ?? now.symbol}`),
      now.simulated ? el("span", { class: "run-simulated" }, words.run.simulated) : null,
      button(words.back, () => actions.list(), { class: "people-back" }),
    );
    const title = el("p", { class: "run-title", lang: stationLanguage }, now.title);
    this.element = el("section", { class: "people-box people-patient people-run", "aria-label": words.run.region(now.code) }, who, title, this.stale, this.trouble, this.refused, this.live, this.result, links);
    this.newest = now;
    this.show(now);
  }

  /// @param stale  the station has not answered for a while
  setStale(stale: boolean): void {
    setShown(this.stale, stale);
    setAttribute(this.element, "data-stale", String(stale));
  }

  /// Whether it has ended, and what it has measured is displayed.
  get showsResult(): boolean {
    return !this.result.hidden;
  }

  /// The note that is being written.
  get draft(): string {
    return this.noteText?.value ?? "";
  }

  show(now: ExerciseNow): void {
    const before = this.newest;
    this.newest = now;
    this.setStale(false);
    const { phase, stage } = now;
    const runs = stage === "running";
    const at = runs ? [phaseText(now), ...(now.training && now.counted > 0 ? [this.texts.successes(String(now.successes), String(now.counted))] : [])].join(" · ") : (this.texts.stages[stage] ?? stage);
    setText(this.phase, at);
    setText(this.instruction, now.instruction);
    setShown(this.instruction, runs && now.instruction !== "");
    setText(this.noted, now.note);
    setShown(this.noted, runs && now.note !== "");
    setText(this.left, runs && now.remaining > 0 && phase !== "paused" ? this.texts.left(String(Math.ceil(now.remaining))) : "");
    setShown(this.progress, runs && phase !== "ready" && phase !== "paused" && phase !== "done");
    this.progress.value = now.progress;
    setAttribute(this.progress, "aria-label", at);
    setText(this.trouble, now.trouble === "" ? "" : `${this.texts.failed} ${now.trouble}`);
    setShown(this.trouble, now.trouble !== "");
    setShown(this.off, runs && now.forcesOff && phase !== "ready" && phase !== "done");
    setShown(this.offHint, phase === "paused");
    setShown(this.start, runs && phase === "ready");
    const paused = runs && phase === "paused";
    if ((paused && this.resume.hidden) || now.stops !== before.stops) this.holdResume();
    setShown(this.resume, paused);
    this.resume.disabled = !paused || this.time() < this.resumeFrom;
    setShown(this.pause, runs && phase !== "ready" && phase !== "paused" && phase !== "done");
    this.pause.disabled = this.pause.hidden;
    setShown(this.skip, runs && (phase === "warm_up" || phase === "rest" || phase === "trial" || phase === "rating"));
    setShown(this.reset, runs && now.forcesOff && phase === "paused");
    const mayEnd = runs && phase !== "done";
    if (!mayEnd) setShown(this.sure, false);
    setShown(this.end, mayEnd && this.sure.hidden);
    this.showChoices(now);
    if (now.asks !== before.asks) this.holdAnswers();
    this.showRatings(now);
    setShown(this.difficulty, runs && now.training);
    this.goal.show(now);
    setShown(this.goal.element, runs && (phase === "trial" || now.value !== undefined));
    this.forces.show(now);
    setShown(this.forces.element, runs);
    setShown(this.live, isUnderWay(now));
    if (stage === "ended") this.showEnd(now);
  }

  private showChoices({ choices, stage }: ExerciseNow): void {
    const wanted = stage === "running" ? choices.join("\n") : "";
    setShown(this.choices, wanted !== "");
    if (wanted === this.shownChoices) return;
    this.shownChoices = wanted;
    this.holdAnswers();
    this.choices.replaceChildren(...(wanted === "" ? [] : choices.map((text, i) => button(text, () => this.answer("answer", i + 1), { lang: stationLanguage, class: "run-choice" }))));
  }

  /// The rating that is asked for; both of them if the patient has said something without being asked.
  private showRatings({ asks, stage }: ExerciseNow): void {
    const runs = stage === "running";
    setShown(this.says, runs);
    setShown(this.pain, asks === "pain" || this.saysOpen);
    setShown(this.fatigue, asks === "fatigue" || this.saysOpen);
    setAttribute(this.pain, "data-asked", String(asks === "pain"));
    setAttribute(this.fatigue, "data-asked", String(asks === "fatigue"));
    const settling = String(this.time() < this.answersFrom);
    for (const one of [this.pain, this.fatigue, this.choices]) setAttribute(one, "data-settling", settling);
  }

  private showEnd(now: ExerciseNow): void {
    if (this.endedShown && !this.result.hidden) return;
    this.endedShown = true;
    setShown(this.result, true);
    const back = button(this.texts.back(now.code), () => this.actions.back(), { class: "primary" });
    this.result.replaceChildren(endedView(now), el("div", { class: "buttons" }, back, button(this.texts.again, () => this.actions.again())));
  }

  private askEnd(asked: boolean): void {
    setShown(this.sure, asked);
    setShown(this.end, !asked);
    if (asked) this.sure.querySelector("button")?.focus();
  }

  private ratings(kind: "pain" | "fatigue", label: string): HTMLElement {
    const press = (value: number) => this.answer(kind, value);
    return el(
      "div",
      { class: "run-ratings", role: "group", "aria-label": label, hidden: true },
      el("span", { class: "quiet-text" }, label),
      el("div", { class: "run-scale" }, ...kRatings.map((value) => button(String(value), () => press(value)))),
    );
  }

  private send(text: string, kind: string, attributes: Readonly<Record<string, string>> = {}): HTMLButtonElement {
    return button(text, () => this.give(kind), attributes);
  }

  private holdResume(): void {
    this.resumeFrom = this.time() + kResumeMs;
    this.resume.disabled = true;
  }

  private holdAnswers(): void {
    this.answersFrom = this.time() + kQuestionMs;
  }

  /// Sends an answer, unless the question has just changed under the finger.
  private answer(kind: string, value: number): void {
    if (this.time() < this.answersFrom) return;
    this.saysOpen = false;
    this.holdAnswers();
    this.give(kind, value);
  }

  private give(kind: string, value?: number): void {
    if (kind === "resume" && this.time() < this.resumeFrom) return;
    setShown(this.refused, false);
    const { stops } = this.newest;
    // What this page has shown when the button was pressed: a stop that came meanwhile stays.
    const values = kind === "resume" && stops !== undefined ? { stops } : value === undefined ? {} : { value };
    void this.actions.input(kind, values).catch((reason: unknown) => {
      setText(this.refused, refusalText(reason));
      setShown(this.refused, true);
    });
  }
}
