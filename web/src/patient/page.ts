// SPDX-License-Identifier: Apache-2.0
// The patient's screen as a whole: what is shown follows from what is known of the station.
import type { Answer } from "../wire/connection";
import type { StopProgress } from "../wire/stop_order";
import { el, setShown, setText } from "../panels/dom";
import { bar } from "./bar";
import { ChangeWatch } from "./changes";
import { makeDemonstration } from "./demonstration";
import type { Demonstration, ExerciseNow, Free, Game, Phase, Rating, Stage } from "./game";
import { gameFor } from "./games/registry";
import { goalOf, holdsStill, type Goal } from "./goal";
import { goalPanel } from "./goal_panel";
import { menu } from "./menu";
import type { Options } from "./options";
import { linePicture } from "./pictures";
import { Practice, type PracticeStep } from "./practice";
import { ratingPanel } from "./rating";
import { signIn } from "./sign_in";
import { Sound } from "./sound";
import { Speech } from "./speech";
import { Stage3d } from "./stage3d";
import type { Known } from "./state";
import { languageCode, words } from "./words";

const kLongestStep = 0.1; // [s]
const kSaidMs = 4000; // for which a confirmation stays
const kBreakBeginsMs = 1000; // within which the stops that a break itself makes are told
const kSignInWords = /sign in/; // of the station's refusal
const playing = new Set(["play", "rest", "answer"]);
const withoutForces = new Set<Phase>(["ready", "rating", "paused", "done"]); // in every other phase, a tap on pain or tired begins a break
const withoutBreak = new Set<Phase>(["ready", "paused", "done"]); // phases in which no break begins
const under = new Set<Stage>(["opening", "running", "closing"]); // an exercise is under way

/// Whether it is known that nothing presses on the hand. A lost connection, a screen that knows of no exercise: it is not.
export const rests = ({ connected, exercise }: Known): boolean => connected === "open" && exercise?.stage === "running" && withoutForces.has(exercise.phase);

/// Whether what the patient or the therapist has opened belongs to the past: another exercise, the end of a break, a lost connection.
export function isOver(before: Known, now: Known): boolean {
  const [one, other] = [before.exercise, now.exercise];
  return now.connected !== "open" || one?.number !== other?.number || one?.stage !== other?.stage || (rests(before) && !rests(now)) || (one?.phase === "paused" && other?.phase !== "paused");
}

/// A break that the patient has asked for.
interface OwnBreak {
  readonly number: number; // of its exercise
  readonly since: number; // [ms]
  readonly stops: number | undefined; // of the station when it began; undefined: the station does not pause yet
}

/// What the page may send.
export interface PageActs {
  readonly stop: () => void;
  readonly pause: () => Promise<Answer>;
  readonly rate: (kind: Rating, value: number) => Promise<Answer>;
  readonly chosen: (options: Options, language: boolean) => void; // by the therapist; language: the page must be opened again
}

export class PatientPage {
  readonly element = el("div", { class: "patient" });
  readonly signIn = signIn(() => this.update());
  readonly sound: Sound;
  private readonly canvas = el("canvas", { class: "stage", "aria-hidden": "true" });
  private readonly gameBox = el("div", { class: "game", "aria-hidden": "true" });
  private readonly goal = goalPanel();
  private readonly rating = ratingPanel((kind, value) => void this.rated(kind, value), () => this.leave());
  private readonly practiceWord = el("p", { class: "practice-word" });
  private readonly practiceSign = el("span", { class: "practice-sign" });
  private readonly practiceHand = el("div", { class: "practice-hand" });
  private readonly practiceBox = el("section", { class: "practice", hidden: true, role: "status" }, this.practiceHand, el("div", { class: "practice-words" }, this.practiceSign, this.practiceWord));
  private readonly bar = bar({ stop: () => this.acts.stop(), pause: () => void this.pause(true), pain: () => this.tapped("pain"), tired: () => this.tapped("tired") });
  private readonly menu = menu((change) => this.choose(change), () => this.openSignIn());
  private readonly stage: Stage3d;
  private readonly speech: Speech;
  private readonly changes = new ChangeWatch();
  private readonly practice = new Practice();
  private readonly demonstration: Demonstration = makeDemonstration(() => this.options.calm);
  private known: Known;
  private game: Game | undefined;
  private gameOf = 0; // number of its exercise
  private broken = 0; // number of an exercise whose game failed: words alone are shown
  private failed = ""; // the last failure that was reported
  private asked: Rating | undefined; // by a tap of the patient
  private own: OwnBreak | undefined;
  private signs = false; // the form was opened by hand, so it may cover an exercise
  private width = 1;
  private height = 1;
  private free = "";
  private stop: StopProgress = "none";
  private said: { readonly text: string; readonly bad: boolean; readonly until: number } | undefined; // for a time, in place of what lasts

  constructor(private readonly acts: PageActs, private options: Options, known: Known) {
    this.known = known;
    this.stage = new Stage3d(this.canvas, () => this.options);
    this.sound = new Sound(() => this.options.sound && !(this.known.exercise?.hidesScene ?? false));
    this.speech = new Speech(words.speech, () => this.options.speech);
    const body = el("div", { class: "patient-body" }, this.goal.element, this.practiceBox, this.rating.element, this.signIn.element);
    this.element.append(this.canvas, this.gameBox, el("div", { class: "shade", "aria-hidden": "true" }), body, this.bar.element, this.menu.opener, this.menu.element);
    this.menu.hold([body, this.menu.opener]);
    this.apply();
    this.update();
  }

  /// Takes what is known now.
  take(known: Known): void {
    const { exercise } = known;
    const before = this.known;
    this.known = known;
    if (isOver(before, known)) {
      this.asked = undefined;
      this.signs = false;
    }
    this.followBreak();
    if (before.exercise?.phase !== exercise?.phase) this.menu.close();
    if (exercise) {
      const { phase, succeeded } = this.changes.take(exercise);
      if (succeeded) this.sound.glad();
      if (phase && exercise.phase === "rating" && exercise.asks === this.asked) this.asked = undefined;
    }
    this.update();
  }

  /// Shows what became of a STOP.
  stopping(progress: StopProgress): void {
    this.stop = progress;
    if (progress !== "none") this.own = undefined;
    if (progress === "confirmed") this.say(words.sent.stopped);
    else this.tell();
  }

  size(width: number, height: number): void {
    [this.width, this.height] = [width, height];
    this.stage.size(width, height);
    this.free = "";
    this.layout();
  }

  /// Draws a frame. @param seconds  since the last one
  frame(seconds: number): void {
    const dt = Math.min(kLongestStep, Math.max(0, seconds));
    const { exercise } = this.known;
    if (this.said && performance.now() > this.said.until) this.tell();
    try {
      this.showPractice(exercise, dt);
      this.layout();
      this.stage.frame(dt, () => exercise && this.game?.show(exercise, dt));
    } catch (reason) {
      this.endBroken(reason);
    }
  }

  /// A game that fails ends. Words and buttons, which do not need it, stay.
  private endBroken(reason: unknown): void {
    if (String(reason) !== this.failed) console.error(reason); // not in each frame again
    this.failed = String(reason);
    if (this.game) this.broken = this.gameOf;
    this.endGame();
  }

  private endGame(): void {
    const { game } = this;
    this.game = undefined;
    this.gameBox.replaceChildren();
    try {
      game?.end();
    } catch (reason) {
      console.error(reason);
    }
  }

  // ---- what is shown

  private update(): void {
    const { exercise } = this.known;
    const goal = goalOf(this.known, words, this.own !== undefined);
    const tapped = this.asked !== undefined; // comes before what the station asks, which waits
    const asks = this.asked ?? (goal.screen === "rating" ? (exercise?.asks ?? "pain") : undefined);
    const needed = this.known.connected === "open" && this.signIn.needed && !this.signIn.later && (this.signs || !this.underWay);
    this.element.dataset["screen"] = needed ? "sign_in" : asks ? "rating" : goal.screen;
    this.element.dataset["asked"] = String(tapped);
    if (exercise) this.bar.setSide(exercise.side);
    this.goal.update(goal, exercise, this.options);
    setShown(this.goal.element, !needed && !tapped);
    this.rating.show(needed ? undefined : asks, this.options, tapped);
    setShown(this.signIn.element, needed);
    this.menu.offerSignIn(this.signIn.needed && !needed);
    if (!this.said) this.tell();
    setShown(this.gameBox, playing.has(goal.screen));
    this.play(goal, exercise);
    this.speak(goal, asks, needed);
  }

  /// Begins and ends the game of the exercise that runs.
  private play(goal: Goal, exercise: ExerciseNow | undefined): void {
    const wanted = exercise && exercise.stage === "running" && playing.has(goal.screen) ? exercise : undefined;
    if (this.game && (!wanted || wanted.number !== this.gameOf)) this.endGame();
    if (!wanted || this.game || wanted.number === this.broken) return;
    this.gameOf = wanted.number;
    // The options are read through the page, so that a game sees those of now.
    const page = this;
    try {
      this.game = gameFor(wanted)?.({ get options() { return page.options; }, sound: this.sound, stage: this.stage });
      if (!this.game) return;
      this.gameBox.replaceChildren(this.game.element);
      this.game.begin(wanted);
      this.free = "";
      this.layout();
    } catch (reason) {
      this.broken = this.gameOf;
      this.endBroken(reason);
    }
  }

  /// Tells the game where nothing covers it.
  private layout(): void {
    if (!this.game) return;
    const above = this.goal.element.getBoundingClientRect();
    const below = this.bar.element.getBoundingClientRect();
    const top = this.goal.element.hidden || above.bottom > 0.6 * this.height ? 0 : Math.max(0, above.bottom);
    let bottom = below.top > top ? below.top : this.height;
    let left = 0;
    if (!this.practiceBox.hidden && this.practiceBox.dataset["step"] === "none") {
      const hand = this.practiceBox.getBoundingClientRect(); // the small one, beside the game
      if (this.width < this.height) bottom = hand.top;
      else if (hand.left < 0.5 * this.width) left = hand.right;
    }
    const free: Free = { left, top, width: this.width - left, height: bottom - top };
    const key = `${this.width} ${this.height} ${left.toFixed(0)} ${top.toFixed(0)} ${bottom.toFixed(0)}`;
    if (key === this.free) return;
    this.free = key;
    this.game.size(this.width, this.height, free);
  }

  private showPractice(exercise: ExerciseNow | undefined, dt: number): void {
    const screen = this.element.dataset["screen"];
    const step: PracticeStep = exercise ? this.practice.take(exercise, this.options.aphasia, dt) : "none";
    const shows = exercise && this.options.aphasia && (screen === "rest" || screen === "play") && (step !== "none" || (exercise.phase === "trial" && !holdsStill(exercise)));
    setShown(this.practiceBox, shows ?? false);
    if (!exercise || !shows) return;
    this.practiceBox.dataset["step"] = step;
    if (this.practiceHand.firstChild !== this.demonstration.element) this.practiceHand.replaceChildren(this.demonstration.element);
    this.demonstration.show(exercise, dt, step === "try");
    const [sign, text] = ({ none: ["eye", ""], watch: ["eye", words.practice.watch], try: ["hand", words.practice.try], understood: ["right", words.practice.understood] } as const)[step];
    if (this.practiceSign.dataset["sign"] !== sign) this.practiceSign.replaceChildren(linePicture(sign));
    this.practiceSign.dataset["sign"] = sign;
    setText(this.practiceWord, text);
  }

  private speak(goal: Goal, asks: Rating | undefined, needed: boolean): void {
    this.speech.say(needed ? "" : asks ? words.rating[asks] : goal.text);
  }

  private get underWay(): boolean {
    return under.has(this.known.exercise?.stage ?? "none");
  }

  /// Says it in the bar for a time.
  private say(text: string, bad = false, forMs = kSaidMs): void {
    this.said = { text, bad, until: performance.now() + forMs };
    this.bar.say(text, bad);
  }

  /// Says in the bar what lasts: a STOP on its way, or else that this screen must be signed in.
  private tell(): void {
    this.said = undefined;
    const { connected } = this.known;
    if (this.stop === "sent" || this.stop === "owed") this.bar.say(this.stop === "owed" ? words.sent.owed : words.sent.stop, this.stop === "owed");
    else if (connected === "open" && this.signIn.needed && this.underWay && this.element.dataset["screen"] !== "sign_in") this.bar.say(words.sent.signIn, true);
    else this.bar.say("");
  }

  // ---- what the patient does

  /// If it fails STOP was sent in its place, and the bar says what becomes of that.
  /// @param own  a break that the patient asks for
  private async pause(own = false): Promise<void> {
    const { exercise } = this.known;
    const { ok, error } = await this.acts.pause();
    if (ok && own && exercise && !withoutBreak.has(exercise.phase)) {
      this.own = { number: exercise.number, since: performance.now(), stops: undefined };
      this.followBreak();
      this.update();
    }
    if (ok) this.say(words.sent.pause);
    else if (kSignInWords.test(error)) this.signIn.refused();
  }

  /// The patient's own break lasts until the exercise goes on, or something else stops it.
  private followBreak(): void {
    const { own } = this;
    const { exercise, stopped, stops } = this.known;
    if (!own) return;
    const pauses = exercise?.phase === "paused" && stopped;
    const begins = performance.now() - own.since < kBreakBeginsMs;
    const isOver = exercise?.number !== own.number || (own.stops !== undefined && (!pauses || (!begins && stops > own.stops)));
    if (isOver) this.own = undefined;
    else if (pauses && (begins || own.stops === undefined)) this.own = { ...own, stops };
  }

  /// Pain or tired: a break begins at once unless it is known that nothing presses, and the faces come if an answer can be sent.
  private tapped(kind: Rating): void {
    const { exercise, connected } = this.known;
    this.menu.close();
    if (!rests(this.known)) void this.pause();
    const isAsked = exercise?.phase === "rating" && exercise.stage === "running" && exercise.asks === kind;
    this.ask(isAsked || connected !== "open" ? undefined : kind);
    if (this.asked) this.rating.focus();
  }

  private openSignIn(): void {
    this.signs = true;
    this.signIn.open();
  }

  private ask(kind: Rating | undefined): void {
    this.asked = kind;
    this.update();
  }

  /// Closes the faces. The focus goes to the button that opened them, since what has it is hidden.
  private leave(): void {
    const { asked } = this;
    this.ask(undefined);
    if (asked) this.bar.focus(asked);
  }

  private async rated(kind: Rating, value: number): Promise<void> {
    this.leave();
    this.sound.note(2, 0.4);
    const answer = await this.acts.rate(kind, value);
    if (answer.ok) return this.say(words.sent.thanks);
    if (kSignInWords.test(answer.error)) this.signIn.refused();
    this.say(words.sent.failed, true, 2 * kSaidMs);
  }

  // ---- what the therapist chooses

  private choose(change: Partial<Options>): void {
    const language = change.language !== undefined && change.language !== languageCode;
    this.options = { ...this.options, ...change };
    if (!this.options.speech) this.speech.hush();
    this.acts.chosen(this.options, language);
    this.apply();
    this.free = "";
    this.update();
  }

  private apply(): void {
    const root = document.documentElement.dataset;
    root["cues"] = this.options.cues;
    root["calm"] = String(this.options.calm);
    root["contrast"] = String(this.options.contrast);
    root["aphasia"] = String(this.options.aphasia);
    this.menu.update(this.options);
  }
}
