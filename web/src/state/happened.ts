// SPDX-License-Identifier: Apache-2.0
// Events as the plots show them.
import type { Notice } from "../gen/phalanx/cockpit_pb";
import { strings } from "../strings";

/// Something that happened.
export interface Happened {
  readonly time: number; // on the ticks' clock [s]
  readonly code: string;
  readonly text: string;
}

/// What is drawn, by shape and colour.
export type MarkKind = "marker" | "bad" | "gap" | "other";

const badCodes = new Set(["fault", "stopped"]);

export function markKind(code: string): MarkKind {
  if (code === "marker") return "marker";
  return badCodes.has(code) ? "bad" : "other";
}

export const eventLabel = (code: string) => strings.replay.kinds[code] ?? strings.replay.otherKind;

/// Those that may change a curve, and a person's markers.
const plotted = new Set(["set", "stopped", "resumed", "reset", "fault", "scene", "source", "opened", "marker", "station"]);
export const isPlotted = (code: string) => plotted.has(code);

/// @param offset  UTC minus the ticks' clock [s]
export function happenedOf(notices: readonly Notice[], offset: number): Happened[] {
  return notices
    .filter(({ code }) => isPlotted(code))
    .map(({ unixTime, code, text }) => ({ time: unixTime - offset, code, text }))
    .sort((a, b) => a.time - b.time);
}
