// SPDX-License-Identifier: Apache-2.0
// The exercise that runs, for the therapist: what the patient should do, how it goes, and the few buttons that it needs now. It is made once
// for an exercise and only changed afterwards, so that a button stays where a finger goes to. “Pause” and “Go on” are two buttons at two
// places: one that changed its meaning could turn the forces on when a patient has just paused.
import { button, el, section, setAttribute, setShown, setText } from "../panels/dom";
import { onPress } from "../panels/press";
import { scoreItem } from "./course_sections";
import { isUnderWay, type ExerciseNow } from "./exercise_now";
import { form } from "./form";
import { Hold, RatingScales } from "./rating_scales";
import { keepFocus, RunningView } from "./running_view";
import { picture } from "./symbols";
import { refusalText } from "./trouble";
import { figureText, stationLanguage, titleText, words } from "./words";

export interface RunningActions {
  input(kind: string, values?: Readonly<Record<string, number>>): Promise<void>;
  note(text: string): Promise<void>;
  back(): void; // to the patient
  list(): void;
  again(): void;
}

const kDifficulties = [0, 0.25, 0.5, 0.75, 1] as const;
const kHundred = 100;
const kMinute = 60; // [s]
const kResumeMs = 1000; // after a pause “Go on” takes no press: the second one of a double tap is none
const kSkipMs = 800; // after a phase has changed, or after a press: the second one would skip what comes next

/// Address of the patient's screen in the language of this page.
export const screenAddress = (language: string): string => `patient.html?${new URLSearchParams({ lang: language }).toString()}`;

/// What an exercise has measured, as soon as it has ended. The values are those of the registry, which makes them from the recording.
function endedView({ result, training }: ExerciseNow): HTMLElement {
  const { title, none } = { title: words.run.result, none: words.run.noResult };
  if (!result) return section(title, el("p", { class: "hint" }, none));
  const { scores, ended, interrupted, repetitions, successes, counted, seconds, verdict } = result;
  const minutes = `${figureText(Math.round((10 * seconds) / kMinute) / 10)} min`;
  return section(
    title,
    verdict === "" ? null : el("p", { class: "run-verdict", lang: stationLanguage }, verdict),
    el("p", { class: "run-facts" }, words.run.facts(String(repetitions), minutes)),
    training && counted > 0 ? el("p", { class: "run-facts" }, words.run.successes(String(successes), String(counted))) : null,
    interrupted ? el("p", { class: "refused" }, words.run.interrupted) : null,
    ended === "" ? null : el("p", { class: "hint", lang: stationLanguage }, ended),
    el("ul", { class: "people-scores" }, ...scores.map(scoreItem)),
  );
}

export class RunningPanel {
  private readonly texts = words.run;
  private readonly view = new RunningView();
  private readonly stale = el("p", { class: "refused", role: "alert", hidden: true }, words.run.stale);
  private readonly trouble = el("p", { class: "refused", role: "alert", hidden: true });
  private readonly refused = el("p", { class: "refused", role: "alert", hidden: true });
  private readonly start = this.send(words.run.start, "begin", { class: "primary run-main" });
  private readonly resume = this.send(words.run.resume, "resume", { class: "primary run-main" });
  private readonly pause = el("button", { type: "button", class: "run-main" }, words.run.pause);
  private readonly skip = this.send(words.run.skip, "skip", { class: "run-skip" });
  private readonly reset = this.send(words.run.reset, "reset", { class: "run-reset" });
  private readonly end = button(words.run.end, () => this.askEnd(true), { class: "quiet run-end" });
  private readonly sure = el(
    "div",
    { class: "run-sure", role: "group", "aria-label": words.run.endSure, tabindex: -1, hidden: true },
    el("span", {}, words.run.endSure),
    this.send(words.run.endYes, "abort", { class: "primary" }),
    button(words.run.endNo, () => this.askEnd(false)),
  );
  private readonly scales: RatingScales;
  private readonly buttons: HTMLElement;
  private readonly difficulty: HTMLElement;
  private readonly live: HTMLElement;
  private readonly result = el("div", { class: "run-result", tabindex: -1, hidden: true });
  private newest: ExerciseNow;
  private endedShown = false;
  private readonly resumeHold: Hold;
  private readonly skipHold: Hold;
  private readonly noteText: HTMLTextAreaElement | null;
  readonly element: HTMLElement;

  constructor(
    readonly number: number,
    now: ExerciseNow,
    private readonly actions: RunningActions,
    language: string,
    time: () => number,
    draft: string,
  ) {
    this.resumeHold = new Hold(time, kResumeMs);
    this.skipHold = new Hold(time, kSkipMs);
    this.scales = new RatingScales((kind, value) => this.give(kind, value), time);
    for (const one of [this.resume, this.pause]) setShown(one, false); // each appears when its phase has come
    onPress(this.pause, () => {
      this.holdResume();
      this.give("pause");
    }); // when the button goes down
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
    const { view, scales } = this;
    this.buttons = el(
      "div",
      { class: "run-buttons run-rows" },
      el("div", { class: "buttons" }, el("div", { class: "run-pair" }, el("div", { class: "run-go" }, this.start, this.resume), this.pause), scales.says),
      el("div", { class: "buttons" }, this.reset, this.skip, this.end),
    );
    const main = el(
      "div",
      { class: "run-column" },
      view.now,
      this.buttons,
      this.sure,
      scales.choices,
      scales.pain,
      scales.fatigue,
      view.off,
      view.goalElement,
    );
    this.live = el("div", { class: "run-live" }, main, el("div", { class: "run-column run-beside" }, view.forces, this.difficulty, note));
    const who = el(
      "header",
      { class: "patient-head" },
      picture(now.symbol),
      el("h2", { tabindex: -1 }, now.code),
      el("p", { class: "patient-who" }, `${words.begin.hand[now.side] ?? now.side}, ${words.symbols[now.symbol] ?? now.symbol}`),
      now.simulated ? el("span", { class: "run-simulated" }, words.run.simulated) : null,
      button(words.back, () => actions.list(), { class: "people-back" }),
    );
    const title = el("p", { class: "run-title" }, titleText(now));
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
    this.view.show(now);
    setText(this.trouble, now.trouble === "" ? "" : `${this.texts.failed} ${now.trouble}`);
    setShown(this.trouble, now.trouble !== "");
    setShown(this.start, runs && phase === "ready");
    const paused = runs && phase === "paused";
    if ((paused && this.resume.hidden) || now.stops !== before.stops) this.holdResume();
    setShown(this.resume, paused);
    this.resume.disabled = !paused || this.resumeHold.holds;
    setShown(this.pause, runs && phase !== "ready" && phase !== "paused" && phase !== "done");
    this.pause.disabled = this.pause.hidden;
    if (phase !== before.phase || now.trial !== before.trial) this.skipHold.begin();
    setShown(this.skip, runs && (phase === "warm_up" || phase === "rest" || phase === "trial" || phase === "rating"));
    setAttribute(this.skip, "aria-disabled", String(this.skipHold.holds)); // never disabled: the focus would be lost
    setShown(this.reset, runs && now.forcesOff && phase === "paused");
    setShown(this.buttons, stage !== "closing"); // a place is kept for what comes, and after the end nothing does
    const mayEnd = runs && phase !== "done";
    if (!mayEnd) setShown(this.sure, false);
    setShown(this.end, mayEnd && this.sure.hidden);
    this.scales.show(now);
    setShown(this.difficulty, runs && now.training);
    setShown(this.live, isUnderWay(now));
    if (stage === "ended") this.showEnd(now);
    keepFocus(this.element, stage === "ended" ? this.result : this.view.now);
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
    (asked ? this.sure : this.end).focus();
  }

  private send(text: string, kind: string, attributes: Readonly<Record<string, string>> = {}): HTMLButtonElement {
    return button(text, () => this.give(kind), attributes);
  }

  private holdResume(): void {
    this.resumeHold.begin();
    this.resume.disabled = true;
  }

  private give(kind: string, value?: number): void {
    if (kind === "resume" && this.resumeHold.holds) return;
    if (kind === "skip") {
      if (this.skipHold.holds) return;
      this.skipHold.begin();
      setAttribute(this.skip, "aria-disabled", "true");
    }
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
