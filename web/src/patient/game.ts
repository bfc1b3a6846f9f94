// SPDX-License-Identifier: Apache-2.0
// What a game gets and what it must do. A game draws the exercise's state in pictures. It sends nothing, scores nothing and decides nothing.
import type { Camera, Scene } from "three";

export type Stage = "none" | "opening" | "running" | "closing" | "ended";
export type Phase = "ready" | "warm_up" | "rating" | "rest" | "trial" | "answer" | "paused" | "done";
export type TargetKind = "none" | "force" | "angle" | "open" | "close" | "squeeze" | "touch" | "explore" | "choose";
export type Side = "left" | "right";
export type Rating = "pain" | "tired";

export interface Target {
  readonly kind: TargetKind;
  readonly digits: readonly number[]; // instructed ones: 0 thumb .. 4 little finger
  readonly force: readonly (number | undefined)[]; // force: of each digit [N], 5; undefined: none
  readonly low: number; // force: ends of the band that `value` should be in [N]
  readonly high: number;
  readonly depth: number; // explore: end position [m]
  readonly sponge: number; // explore: 0 or 1; -1: none
  readonly flexion: readonly (number | undefined)[]; // angle: of each digit, as ExerciseNow.flexion, 5; undefined: none
}

/// The exercise as the station's newest message has it (Exercise in cockpit.proto), in plain fields.
export interface ExerciseNow {
  readonly number: number; // since the program's start, from 1; 0: none has begun
  readonly name: string;
  readonly title: string; // in English
  readonly measure: string; // press_and_hold, ...
  readonly training: boolean;
  readonly symbol: string; // of the patient; empty: none
  readonly side: Side; // of the hand that does it
  readonly simulated: boolean;
  readonly stage: Stage;
  readonly phase: Phase;
  readonly instruction: string; // in English; goal.ts translates
  readonly note: string; // in English; not for the patient
  readonly trial: number; // from 1; 0: none began
  readonly trials: number;
  readonly progress: number; // of the phase, 0 .. 1
  readonly remaining: number; // of the phase [s]; 0: it does not end by time
  readonly target: Target;
  readonly value: number | undefined; // what the target refers to, [N] or [deg]
  readonly valueUnit: string;
  readonly choices: readonly string[]; // in English
  readonly asks: Rating | undefined;
  readonly hidesScene: boolean; // hand, object and forces must neither be seen nor heard; force and touching are empty then
  readonly successes: number; // of a training
  readonly counted: number; // of a training: valid trials
  readonly lastSuccess: boolean; // of a training: the last counted trial
  readonly force: readonly number[]; // of each digit [N]; 5, or empty
  readonly touching: readonly boolean[]; // 5, or empty
  readonly flexion: readonly number[]; // of each digit, 0 open .. 1 closed; 5, or empty
  readonly padDistance: readonly number[]; // thumb's pad to the pads of index .. little finger [m]; 4, or empty
  readonly forcesOff: boolean;
  readonly trouble: string;
}

/// Choices of the therapist for this screen, as far as they concern a game.
export interface GameOptions {
  readonly aphasia: boolean; // no written words in the game
  readonly numbers: boolean; // figures may be shown; the frame shows the value itself
  readonly cues: Side | "centre"; // side of what has to be seen. The frame moves words and the 3D picture; a game in SVG moves its own
  readonly calm: boolean; // reduced motion: nothing drifts or sways by itself, changes fade
  readonly contrast: boolean; // high contrast: plain dark ground, strong edges
}

/// Sounds of the page; silent if sound is off, or while the exercise hides its scene.
export interface GameSound {
  /// A soft note, as of a kalimba. @param pitch  0 thumb .. 4 little finger, others continue the pentatonic scale  @param loudness  0 .. 1
  note(pitch: number, loudness?: number): void;
  /// Two or three rising notes: a trial was successful.
  glad(): void;
}

/// The page's one WebGL canvas behind everything. A game that draws nothing on it has the page's calm sky behind it.
export interface GameStage {
  readonly able: boolean; // false: this browser draws no 3D; the game shows its `element` alone
  /// Draws this frame in place of the sky. It sets the camera's aspect and shifts the picture towards the side of the cues.
  draw(scene: Scene, camera: Camera): void;
}

/// Rectangle, in pixels of the page from its upper left corner, that words and buttons of the frame leave free.
export interface Free {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

export interface GameParts {
  readonly options: GameOptions; // of now: read them in show()
  readonly sound: GameSound;
  readonly stage: GameStage;
}

/// A game of one exercise. It is on the screen in the phases warm_up, rest, trial and answer.
export interface Game {
  /// Fills the page behind words and buttons; without controls, hidden from screen readers by the frame. Empty if all is on the stage.
  readonly element: HTMLElement;
  /// Called once, before anything else.
  begin(exercise: ExerciseNow): void;
  /// Called in each frame. @param dt  since the last call, at most 0.1 [s]
  show(exercise: ExerciseNow, dt: number): void;
  /// Called before the first show() and after each change. @param free  where what matters should be
  size(width: number, height: number, free: Free): void;
  /// Called once; gives back what three.js keeps on the graphics card.
  end(): void;
}

export type MakeGame = (parts: GameParts) => Game;

/// The drawn hand that demonstrates a movement and mirrors the patient's own (demonstration.ts: `export function makeDemonstration(): Demonstration`).
export interface Demonstration {
  readonly element: HTMLElement; // fills its parent; about 1 : 1
  /// Called in each frame. @param own  false: the hand moves as it should for this exercise; true: as the patient's hand does
  show(exercise: ExerciseNow, dt: number, own: boolean): void;
}
