// SPDX-License-Identifier: Apache-2.0
import type { Tick } from "../gen/phalanx/tick_pb";
import type { Shapes } from "../view3d/shapes";
import type { Circumstances } from "./circumstances";
import type { Happened } from "./happened";
import type { History } from "./history";
import type { VerdictLight } from "./verdict";

export type Topic = "state" | "tick" | "notice" | "geometry" | "connection" | "own";

/// Why curves are not those of the displayed moment; empty: they are.
export type OldCurves = "" | "offline" | "silent" | "unmeasured";

/// The source of the 3D view, the plots and the figures: a running station (Store) or a recording (Player).
export interface Shown {
  readonly tick: Tick | undefined;
  readonly geometry: Shapes | undefined;
  readonly history: History;
  readonly light: VerdictLight;
  readonly lost: boolean; // the tick is not that of the displayed moment
  readonly viewDead: boolean; // likewise the picture: the hand turns grey
  readonly oldCurves: OldCurves;
  readonly slides: boolean; // contacts slide, with friction
  readonly sensedJoint: readonly number[]; // that the device measures or moves
  readonly rendersTorque: boolean;
  readonly objectKind: string; // as scenes name it; empty: not known
  readonly digitLimit: number; // of a digit's force [N]; Infinity: none, or not known
  readonly recordedAt?: number; // of the displayed moment of a recording, UTC [s]; absent for a running station
  readonly windows: readonly number[]; // lengths of time that the plots can show [s], rising
  readonly happened: readonly Happened[]; // in the order of time
  readonly utcOffset: number; // UTC minus the ticks' clock [s]; NaN: not known
  readonly circumstances: readonly Circumstances[]; // by their numbers in the history
  /// The history is to reach back so far. @param seconds  one of `windows`
  reachBack(seconds: number): void;
  on(topics: readonly Topic[], listener: () => void): void;
}

/// Curves that can be held while the hand goes on.
export interface Pausing {
  readonly paused: boolean;
  setPaused(paused: boolean): void;
}
