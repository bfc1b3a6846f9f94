// SPDX-License-Identifier: Apache-2.0
// The exercise that runs, while the page is locked: how it goes, without whose it is. It can be paused, and what the patient says can be
// entered. Everything else needs the password.
import { el, section, setAttribute, setShown, setText } from "../panels/dom";
import { onPress } from "../panels/press";
import { PeopleError } from "./api";
import { isUnderWay, type ExerciseNow } from "./exercise_now";
import { RatingScales } from "./rating_scales";
import { keepFocus, RunningView } from "./running_view";
import { titleText, words } from "./words";

export type WatchedInput = (kind: string, number: number, values?: Readonly<Record<string, number>>) => Promise<void>;

/// An exercise without what tells whose it is.
export const withoutPatient = (now: ExerciseNow): ExerciseNow => ({ ...now, record: "", code: "", symbol: "", side: "", recording: "", trouble: "", result: undefined });

export class WatchedPanel {
  private readonly view = new RunningView(words.lock.paused, words.lock.forcesOffHint);
  private readonly title = el("p", { class: "run-title" });
  private readonly stale = el("p", { class: "refused", role: "alert", hidden: true });
  private readonly said = el("p", { role: "status" });
  private readonly pause = el("button", { type: "button", class: "run-main" }, words.run.pause);
  private readonly scales: RatingScales;
  private readonly live: HTMLElement;
  private readonly over = el("p", { class: "run-facts", role: "status", hidden: true }, words.lock.ended);
  private newest: ExerciseNow | undefined;
  readonly element: HTMLElement;

  /// @param input  the station takes it from a locked session, too  @param time  [ms]
  constructor(
    private readonly input: WatchedInput,
    time: () => number,
  ) {
    this.scales = new RatingScales((kind, value) => this.give(kind, { value }), time);
    onPress(this.pause, () => this.give("pause")); // when the button goes down
    const { view, scales } = this;
    const main = el("div", { class: "run-column" }, view.now, el("div", { class: "buttons run-buttons" }, scales.says, this.pause), this.said, scales.pain, scales.fatigue, view.off, view.goalElement);
    this.live = el("div", { class: "run-live" }, main, el("div", { class: "run-column run-beside" }, view.forces));
    this.element = el("div", { class: "people-box people-patient people-run people-watched", hidden: true }, section(words.lock.watch, this.title, this.stale, this.live, this.over));
  }

  /// @param now  without its patient
  show(now: ExerciseNow): void {
    if (this.newest && this.newest.number !== now.number) setText(this.said, "");
    const seen = this.newest?.number === now.number && !this.element.hidden;
    this.newest = now;
    this.setStale("");
    const runs = isUnderWay(now);
    setShown(this.element, runs || (seen && now.stage === "ended"));
    setText(this.title, titleText(now));
    this.view.show(now);
    this.scales.show({ ...now, choices: [] });
    setShown(this.pause, now.stage === "running" && !["ready", "paused", "done"].includes(now.phase));
    setShown(this.live, runs);
    setShown(this.over, !runs);
    keepFocus(this.element, this.view.now);
  }

  /// @param why  what is displayed is no longer live; empty: it is
  setStale(why: string): void {
    setText(this.stale, why);
    setShown(this.stale, why !== "");
    setAttribute(this.element, "data-stale", String(why !== ""));
  }

  private give(kind: string, values?: Readonly<Record<string, number>>): void {
    const { newest } = this;
    if (!newest) return;
    const pauses = kind === "pause";
    const done = () => setText(this.said, pauses ? words.lock.pauseSent : words.lock.ratingSent);
    void this.input(kind, newest.number, values).then(done, (reason: unknown) => {
      // The station takes a pause before it looks at the session, which may have ended meanwhile.
      if (pauses && reason instanceof PeopleError && reason.trouble === "signed_out") return setText(this.said, words.lock.pauseUnsure);
      const gone = !(reason instanceof PeopleError) || reason.trouble === "gone";
      setText(this.said, gone ? words.lock.pauseFailed : reason.message);
    });
  }
}
