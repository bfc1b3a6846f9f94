// SPDX-License-Identifier: Apache-2.0
// Which files the station calibrates with, from the cockpit's page to the page of patients of the same browser: a therapist calibrates in the
// cockpit, and binds the file to a patient. A BroadcastChannel, which pages of another address do not hear. No field of a patient goes over it.

const kChannel = "phalanx.calibration";
const kQuestion = "calibration?";

/// Files of the station; empty: none.
export interface CalibrationFiles {
  readonly calibration: string;
  readonly range: string;
}

const text = (value: unknown): string => (typeof value === "string" ? value : "");

/// The cockpit's end. @returns tells the other pages what the station uses now
export function tellCalibration(): (files: CalibrationFiles) => void {
  const channel = new BroadcastChannel(kChannel);
  let newest: CalibrationFiles | undefined;
  channel.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
    if (data === kQuestion && newest) channel.postMessage(newest);
  });
  return (files) => {
    if (newest && newest.calibration === files.calibration && newest.range === files.range) return;
    newest = files;
    channel.postMessage(files);
  };
}

/// The end of the page of patients: asks the open cockpits, and hears what they tell afterwards.
export function hearCalibration(heard: (files: CalibrationFiles) => void): void {
  const channel = new BroadcastChannel(kChannel);
  channel.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
    if (typeof data !== "object" || data === null || !("calibration" in data)) return;
    heard({ calibration: text(data.calibration), range: "range" in data ? text(data.range) : "" });
  });
  channel.postMessage(kQuestion);
}

/// What the address of the cockpit asks it to open: "calibration" or "range"; empty: nothing.
export function wantedDialog(search: string): "" | "calibration" | "range" {
  const wanted = new URLSearchParams(search).get("open");
  return wanted === "calibration" || wanted === "range" ? wanted : "";
}
