// SPDX-License-Identifier: Apache-2.0
// What the patient's screen knows: the connection, the station's state and the exercise in plain fields.
import {
  Exercise_Phase, Exercise_Stage, Exercise_Target_Kind, Feel_Kind, type Exercise, type Exercise_Target, type State,
} from "../gen/phalanx/cockpit_pb";
import { SafetyState } from "../gen/phalanx/tick_pb";
import type { Phase as Connected } from "../wire/connection";
import type { ExerciseNow, Phase, Rating, Stage, Target, TargetKind } from "./game";

const stages: readonly Stage[] = ["none", "opening", "running", "closing", "ended"]; // by Exercise_Stage
const phases: readonly Phase[] = ["ready", "warm_up", "rating", "rest", "trial", "answer", "paused", "done"];
const kinds: readonly TargetKind[] = ["none", "force", "angle", "open", "close", "squeeze", "touch", "explore", "choose"];
export const stageOf = (stage: Exercise_Stage): Stage => stages[stage] ?? "none";
export const phaseOf = (phase: Exercise_Phase): Phase => phases[phase] ?? "paused";
export const kindOf = (kind: Exercise_Target_Kind): TargetKind => kinds[kind] ?? "none";
export const ratingOf = (kind: Feel_Kind): Rating | undefined => (kind === Feel_Kind.PAIN ? "pain" : kind === Feel_Kind.TIRED ? "tired" : undefined);

const known = (value: number) => (Number.isFinite(value) ? value : undefined);
export const noTarget: Target = { kind: "none", digits: [], force: [], low: 0, high: 0, depth: 0, sponge: -1, flexion: [] };

function targetOf(target: Exercise_Target | undefined): Target {
  if (!target) return noTarget;
  return {
    kind: kindOf(target.kind), digits: target.digit, force: target.force.map(known), low: target.low, high: target.high, depth: target.depth,
    sponge: target.sponge, flexion: target.flexion.map(known),
  };
}

export function exerciseOf(message: Exercise): ExerciseNow {
  const { number, name, title, measure, training, symbol, simulated, instruction, note, trial, trials, progress, remaining, value, valueUnit } = message;
  return {
    number, name, title, measure, training, symbol, simulated, instruction, note, trial, trials, progress, remaining, valueUnit,
    side: message.side === "left" ? "left" : "right", stage: stageOf(message.stage), phase: phaseOf(message.phase), target: targetOf(message.target),
    value: value === undefined ? undefined : known(value), choices: message.choice, asks: ratingOf(message.asks), hidesScene: message.hidesScene,
    successes: message.successes, counted: message.counted, lastSuccess: message.lastSuccess, force: message.force, touching: message.touching,
    flexion: message.flexion, padDistance: message.padDistance, forcesOff: message.forcesOff, trouble: message.trouble,
  };
}

/// Everything that the screen is made from.
export interface Known {
  readonly connected: Connected;
  readonly ever: boolean; // a Welcome has come
  readonly stopped: boolean; // the torque is held at zero until a person resumes
  readonly stops: number; // that the station has made; a pause is one of them
  readonly fault: boolean;
  readonly exercise: ExerciseNow | undefined;
}

export const nothingKnown: Known = { connected: "connecting", ever: false, stopped: false, stops: 0, fault: false, exercise: undefined };

/// @returns what `known` becomes with the station's newest state
export function withState(before: Known, state: State): Known {
  const stopped = state.heldStopped || state.safety === SafetyState.SAFETY_STOPPED;
  const fault = state.fault !== undefined || state.stationGone;
  return { ...before, stopped, stops: Number(state.stops), fault };
}
