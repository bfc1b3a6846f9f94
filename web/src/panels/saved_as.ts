// SPDX-License-Identifier: Apache-2.0
// Names and marks of saved pictures and tables: those of a recording cannot be mistaken for those of a running station.
import type { Shown } from "../state/shown";
import { strings } from "../strings";
import { stamp } from "./dom";

/// The file's name without its ending. A recording's has the recorded moment, not today's date.
export function savedName({ recordedAt }: Shown): string {
  return recordedAt === undefined ? `phalanx-${stamp()}` : `phalanx-recording-${stamp(new Date(1000 * recordedAt))}`;
}

/// Words that are drawn into a saved picture; empty for a running station.
export function savedMark({ recordedAt }: Shown): string {
  return recordedAt === undefined ? "" : strings.replay.watermark;
}
