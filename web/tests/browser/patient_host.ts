// SPDX-License-Identifier: Apache-2.0
// A station without a device that sends the patient's screen what it is told, so that every state of it can be looked at.
import { create, fromBinary, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import type { Page, WebSocketRoute } from "playwright-core";
import {
  ExerciseSchema, Exercise_Phase, Exercise_Stage, Exercise_Target_Kind, Feel_Kind, NoticeSchema, StateSchema, ToHostSchema, ToPageSchema, WelcomeSchema, type ToHost,
} from "../../src/gen/phalanx/cockpit_pb";
import { SafetyState } from "../../src/gen/phalanx/tick_pb";
import { kProtocol } from "../../src/wire/connection";

export type ExerciseInit = Extract<MessageInitShape<typeof ExerciseSchema>, { $typeName?: never }>;
const kPeriodMs = 1000 / 30;
const kTouch = 0.004; // distance of two pads that touch [m]
const kApart = 0.07;

/// Fields of an exercise that has begun: a patient with the symbol of a boat, right hand.
const base: ExerciseInit = {
  number: 1, name: "train_tracking", title: "Training: follow a moving target with the index finger's force", measure: "force_tracking", training: true,
  symbol: "boat", side: "right", stage: Exercise_Stage.RUNNING, phase: Exercise_Phase.READY, trials: 20, flexion: [0.1, 0.15, 0.12, 0.1, 0.1],
  force: [0, 0, 0, 0, 0], touching: [false, false, false, false, false], padDistance: [kApart, kApart, kApart, kApart], target: {},
};

export class PatientHost {
  readonly asked: ToHost[] = [];
  refuse = ""; // what is felt is refused in these words
  accounts = false;
  down = false;
  expired = false; // the page's own address is refused
  fault = false;
  stopped = false;
  private stops = 0n;
  private exercise: ExerciseInit | undefined;
  private script: ((t: number) => ExerciseInit) | undefined;
  private socket: WebSocketRoute | null = null;
  private timer: ReturnType<typeof setInterval> | undefined;
  private number = 0;
  private began = Date.now();

  async attach(page: Page): Promise<void> {
    await page.routeWebSocket("**/stream", (socket) => {
      if (this.down) return void socket.close();
      this.socket = socket;
      socket.onMessage((data) => typeof data !== "string" && this.received(fromBinary(ToHostSchema, new Uint8Array(data))));
      socket.onClose(() => clearInterval(this.timer));
    });
    await page.route("**/stop", (route) => {
      this.stop();
      return route.fulfill({ status: 200, body: "stopped" });
    });
    await page.route("**/patient.html*", (route) => (this.expired ? route.fulfill({ status: 403, body: "" }) : route.fallback()));
    await page.route("**/people", (route) => route.fulfill({ status: 200, contentType: "application/json", body: JSON.stringify({ accounts: this.accounts, idle_s: 300 }) }));
  }

  /// Plays an exercise from now on. @param script  its fields, t seconds after this call
  play(script: (t: number) => ExerciseInit): void {
    this.script = script;
    ++this.number;
    this.began = Date.now();
    this.sendExercise();
  }

  /// Goes on with the same exercise, as after a break.
  goOn(script: (t: number) => ExerciseInit): void {
    this.script = script;
    this.stopped = false;
    this.say();
    this.sendExercise();
  }

  show(exercise: ExerciseInit): void {
    this.play(() => exercise);
  }

  idle(): void {
    this.script = undefined;
    this.exercise = undefined;
    this.send({ case: "exercise", value: create(ExerciseSchema) });
  }

  send(what: NonNullable<MessageInitShape<typeof ToPageSchema>["what"]>): void {
    this.socket?.send(Buffer.from(toBinary(ToPageSchema, create(ToPageSchema, { what }))));
  }

  say(): void {
    this.send({
      case: "state",
      value: create(StateSchema, {
        safety: this.stopped ? SafetyState.SAFETY_STOPPED : SafetyState.SAFETY_RUNNING, heldStopped: this.stopped, stops: this.stops,
        ...(this.fault ? { fault: { name: "sensor", meaning: "", remedy: "" } } : {}),
      }),
    });
  }

  /// Another window is this screen now.
  replace(): void {
    this.send({ case: "notice", value: create(NoticeSchema, { code: "replaced" }) });
  }

  async cut(): Promise<void> {
    this.down = true;
    clearInterval(this.timer);
    await this.socket?.close({ code: 1006 }).catch(() => this.socket?.close());
  }

  end(): void {
    clearInterval(this.timer);
  }

  private stop(): void {
    this.stopped = true;
    ++this.stops;
    if (this.exercise?.stage === Exercise_Stage.RUNNING) {
      const paused = { ...this.exercise, phase: Exercise_Phase.PAUSED, forcesOff: true, target: {} };
      this.script = () => paused;
    }
  }

  private received(message: ToHost): void {
    this.asked.push(message);
    const { what, request } = message;
    let error = "";
    if (what.case === "hello") return this.welcome();
    if (what.case === "stop") this.stop();
    if (what.case === "feel") {
      error = this.refuse;
      if (error === "" && what.value.kind === Feel_Kind.PAUSE) this.stop();
    }
    if (request !== 0) this.send({ case: "reply", value: { $typeName: "phalanx.wire.Reply", request, ok: error === "", error } });
    this.say();
    this.sendExercise();
  }

  private welcome(): void {
    this.send({ case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, version: "0.1.0", page: 3, secret: "s3cret" }) });
    this.say();
    this.sendExercise();
    clearInterval(this.timer);
    let count = 0;
    this.timer = setInterval(() => {
      if (++count % 15 === 0) this.say();
      this.sendExercise();
    }, kPeriodMs);
  }

  private sendExercise(): void {
    if (!this.script) return;
    this.exercise = { ...base, number: this.number, ...this.script((Date.now() - this.began) / 1000) };
    this.send({ case: "exercise", value: create(ExerciseSchema, this.exercise) });
  }
}

// ---- exercises as a station would send them

const K = Exercise_Target_Kind;
const P = Exercise_Phase;
const digits = (...which: number[]) => which;
const forces = (digit: number, force: number) => Array.from({ length: 5 }, (_, i) => (i === digit ? force : 0));
const touch = (force: readonly number[]) => force.map((one) => one > 0.05);

/// The moving target of force_tracking, and a hand that follows it late.
export function tracking(t: number, trial = 3): ExerciseInit {
  const factor = (at: number) => 1 + 0.5 * Math.sin(2 * Math.PI * 0.18 * at);
  const [mean, half] = [1.6, 0.36];
  const value = mean * factor(t - 0.3) + 0.1 * Math.sin(3 * t);
  const force = forces(1, value);
  return {
    phase: P.TRIAL, instruction: "Keep the bar on the moving target.", trial, successes: Math.max(0, trial - 2), counted: trial - 1, lastSuccess: true,
    progress: (t % 10) / 10, remaining: 10 - (t % 10), target: { kind: K.FORCE, digit: digits(1), low: mean * factor(t) - half, high: mean * factor(t) + half, sponge: -1, force: forces(1, mean) },
    value, valueUnit: "N", force, touching: touch(force), flexion: [0.2, 0.35 + 0.1 * value, 0.2, 0.15, 0.15],
  };
}

export function pressing(t: number): ExerciseInit {
  const value = 2 * (1 - Math.exp(-t / 1.2)) + 0.05 * Math.sin(2 * t);
  const force = forces(1, value);
  return {
    name: "train_press", measure: "press_and_hold", phase: P.TRIAL, instruction: "Press until the bar is in the band, and hold it there.", trial: 12, trials: 30,
    successes: 8, counted: 11, progress: (t % 6) / 6, remaining: 6 - (t % 6), target: { kind: K.FORCE, digit: digits(1), low: 1.7, high: 2.3, sponge: -1, force: forces(1, 2) },
    value, valueUnit: "N", force, touching: touch(force), flexion: [0.2, 0.5, 0.2, 0.15, 0.15],
  };
}

export function squeezing(t: number): ExerciseInit {
  const phase = t % 6;
  const value = phase < 3 ? 5 * (1 - Math.exp(-phase / 0.3)) : 5 * Math.exp(-(phase - 3) / 0.3);
  const force = forces(1, value);
  return {
    name: "squeeze", measure: "squeeze_release", training: true, phase: P.TRIAL, instruction: phase < 3 ? "Press quickly and strongly." : "Let go now.", trial: 2, trials: 5,
    progress: phase / 6, remaining: 6 - phase, target: { kind: phase < 3 ? K.SQUEEZE : K.OPEN, digit: digits(1), sponge: -1 }, value, valueUnit: "N", force, touching: touch(force),
  };
}

/// A movement of the hand between open and closed.
export function ranging(t: number): ExerciseInit {
  const phase = t % 9;
  const closed = phase > 3 && phase < 6;
  const flexion = Array.from({ length: 5 }, (_, i) => 0.1 + (closed ? 0.75 : 0.02) * Math.min(1, (phase % 3) / (1.2 + 0.1 * i)));
  return {
    name: "range_of_motion", measure: "range_of_motion", training: false, phase: P.TRIAL, trial: 1, trials: 3, progress: phase / 9, remaining: 9 - phase,
    instruction: closed ? "Close your hand as far as you can." : "Open your hand as far as you can.",
    target: { kind: closed ? K.CLOSE : K.OPEN, digit: digits(0, 1, 2, 3, 4), sponge: -1 }, flexion,
  };
}

export function opposing(t: number): ExerciseInit {
  const near = Math.abs(Math.sin(0.8 * t));
  return {
    name: "train_opposition", measure: "opposition", phase: P.TRIAL, trial: 6, trials: 40, successes: 4, counted: 5, instruction: "Touch the fingertip with your thumb (ring)",
    progress: (t % 5) / 5, remaining: 5 - (t % 5), target: { kind: K.TOUCH, digit: digits(0, 3), sponge: -1 }, padDistance: [kApart, 0.06, kTouch + (kApart - kTouch) * (1 - near), kApart],
    flexion: [0.4 * near, 0.2, 0.25, 0.6 * near, 0.2],
  };
}

export function feeling(t: number): ExerciseInit {
  return {
    name: "feel_and_find", measure: "feel_and_find", training: false, phase: P.TRIAL, trial: 7, trials: 40, hidesScene: true, instruction: "Press slowly until you are told to stop, then let go.",
    progress: (t % 8) / 8, remaining: 8 - (t % 8), target: { kind: K.EXPLORE, digit: digits(1), sponge: Math.floor(t / 4) % 2, depth: 0.005 }, force: [], touching: [], flexion: [0.2, 0.3 + 0.1 * Math.sin(t), 0.2, 0.2, 0.2],
  };
}

export const lettingGo: ExerciseInit = { phase: P.REST, instruction: "Let go. The second one comes.", target: {} };
export const answering: ExerciseInit = {
  name: "feel_and_find", measure: "feel_and_find", training: false, phase: P.ANSWER, trial: 7, trials: 40, hidesScene: true, instruction: "Which one was softer?",
  target: { kind: K.CHOOSE, sponge: -1 }, choice: ["the first", "the second"], force: [], touching: [],
};
export const naming: ExerciseInit = { ...answering, name: "object_in_hand", measure: "object_in_hand", instruction: "What was in your hand?", choice: ["a ball", "a cube", "a cylinder"], trials: 12 };
export const warming = (t: number): ExerciseInit => ({ phase: P.WARM_UP, trial: 1, instruction: "Warm up: move your fingers freely.", progress: (t % 30) / 30, remaining: 30 - (t % 30), flexion: [0.3, 0.4, 0.4, 0.4, 0.4].map((one) => one + 0.3 * Math.sin(1.5 * t)) });
export const resting = (t: number): ExerciseInit => ({ phase: P.REST, trial: 4, successes: 3, counted: 3, instruction: "Rest. The next trial comes.", progress: (t % 5) / 5, remaining: 5 - (t % 5) });
export const asking = (kind: Feel_Kind): ExerciseInit => ({ phase: P.RATING, trial: 1, asks: kind, progress: 0.2, remaining: 24 });
export const paused: ExerciseInit = { phase: P.PAUSED, trial: 4, instruction: "Paused.", forcesOff: true };
export const troubled: ExerciseInit = { stage: Exercise_Stage.ENDED, phase: P.DONE, trial: 0, trouble: "the hand is not calibrated" };
export const ended: ExerciseInit = { stage: Exercise_Stage.ENDED, phase: P.DONE, trial: 20, successes: 15, counted: 20 };
