// SPDX-License-Identifier: Apache-2.0
// The exercise that the station carries out, as its answer says, read defensively.
import { entry, figure, list, scoreReader, text, texts, type ScoreValue } from "./shapes";

/// none: none has begun since the program's start; ended: the result stands.
export type Stage = "none" | "opening" | "running" | "closing" | "ended";
export type Phase = "ready" | "warm_up" | "rating" | "rest" | "trial" | "answer" | "paused" | "done";

export interface Ended {
  readonly scores: readonly ScoreValue[];
  readonly ended: string; // why, in the station's words
  readonly interrupted: boolean;
  readonly repetitions: number;
  readonly successes: number;
  readonly counted: number;
  readonly seconds: number;
  readonly verdict: string; // of an entry check; else empty
}

/// A fault of the station in its own words.
export interface FaultWords {
  readonly name: string;
  readonly meaning: string;
  readonly remedy: string;
}

export interface ExerciseNow {
  readonly number: number; // since the program's start
  readonly stage: Stage;
  readonly record: string;
  readonly code: string;
  readonly symbol: string;
  readonly side: string;
  readonly name: string;
  readonly title: string;
  readonly titleDe: string; // empty: its file has none
  readonly measure: string;
  readonly training: boolean;
  readonly simulated: boolean;
  readonly phase: Phase;
  readonly instruction: string;
  readonly note: string; // the last event
  readonly trial: number;
  readonly trials: number;
  readonly progress: number; // of the phase, 0 .. 1
  readonly remaining: number; // of the phase [s]; 0: it does not end by time
  readonly target: string; // kind
  readonly digits: readonly string[]; // instructed
  readonly low: number | undefined; // ends of the band of the value
  readonly high: number | undefined;
  readonly value: number | undefined;
  readonly unit: string;
  readonly choices: readonly string[];
  readonly asks: "" | "pain" | "fatigue";
  readonly successes: number;
  readonly counted: number;
  readonly forces: readonly number[]; // of each digit [N]; empty: hidden
  readonly forcesOff: boolean;
  readonly fault: FaultWords | undefined; // the station's present fault
  readonly stops: number | undefined; // that the station has made: "go on" states it, so that it ends no later one
  readonly trouble: string;
  readonly recording: string;
  readonly result: Ended | undefined;
}

const stages: readonly string[] = ["none", "opening", "running", "closing", "ended"];
const phases: readonly string[] = ["ready", "warm_up", "rating", "rest", "trial", "answer", "paused", "done"];

function readEnded(value: unknown): Ended | undefined {
  if (typeof value !== "object" || value === null) return undefined;
  const one = entry(value);
  return {
    scores: list(one["scores"]).map(entry).map(scoreReader(one["names"])), ended: text(one["ended"]), interrupted: one["interrupted"] === true, repetitions: figure(one["repetitions"]) ?? 0,
    successes: figure(one["successes"]) ?? 0, counted: figure(one["counted"]) ?? 0, seconds: figure(one["seconds"]) ?? 0, verdict: text(one["verdict"]),
  };
}

function readFault(value: unknown): FaultWords | undefined {
  if (typeof value !== "object" || value === null) return undefined;
  const one = entry(value);
  return { name: text(one["name"]), meaning: text(one["meaning"]), remedy: text(one["remedy"]) };
}

export function readExerciseNow(answer: unknown): ExerciseNow {
  const one = entry(answer);
  const target = entry(one["target"]);
  const stage = text(one["stage"]);
  const phase = text(one["phase"]);
  const asks = text(one["asks"]);
  return {
    number: figure(one["number"]) ?? 0, stage: (stages.includes(stage) ? stage : "none") as Stage, record: text(one["record"]), code: text(one["code"]),
    symbol: text(one["symbol"]), side: text(one["side"]), name: text(one["name"]), title: text(one["title"]) || text(one["name"]), titleDe: text(one["title_de"]), measure: text(one["measure"]),
    training: text(one["kind"]) === "training", simulated: one["simulated"] === true, phase: (phases.includes(phase) ? phase : "ready") as Phase,
    instruction: text(one["instruction"]), note: text(one["note"]), trial: figure(one["trial"]) ?? 0, trials: figure(one["trials"]) ?? 0,
    progress: Math.min(1, Math.max(0, figure(one["progress"]) ?? 0)), remaining: figure(one["remaining_s"]) ?? 0, target: text(target["kind"]), digits: texts(target["digits"]),
    low: figure(target["low"]), high: figure(target["high"]), value: figure(one["value"]), unit: text(one["value_unit"]), choices: texts(one["choices"]),
    asks: asks === "pain" || asks === "fatigue" ? asks : "", successes: figure(one["successes"]) ?? 0, counted: figure(one["counted"]) ?? 0,
    forces: list(one["force"]).map((force) => figure(force) ?? 0), forcesOff: one["forces_off"] === true, fault: readFault(one["fault"]), stops: figure(one["stops"]), trouble: text(one["trouble"]),
    recording: text(one["recording"]), result: readEnded(one["result"]),
  };
}

/// Whether the station is at it: between the wish to begin and the result.
export const isUnderWay = ({ stage }: ExerciseNow): boolean => stage === "opening" || stage === "running" || stage === "closing";
