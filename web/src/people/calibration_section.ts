// SPDX-License-Identifier: Apache-2.0
// The calibration of a patient: what is bound, the way into the cockpit's dialog, and what it has made since, to be bound.
import { el, section } from "../panels/dom";
import type { OfferedFiles } from "./calibration_offer";
import { form } from "./form";
import { fieldText, type Patient } from "./shapes";
import { words } from "./words";

const kDateLength = 10;

/// Today by the station's calendar, which is UTC, as 2026-05-04: the most careful last day that is proposed.
export const today = (now = new Date()): string => now.toISOString().slice(0, kDateLength);

/// @param station  files that the cockpit has made for this patient, to be bound; absent: none
/// @param save     changes fields of the patient; what it throws is shown
/// @param begin    is called when the cockpit's dialog is opened for this patient
export function calibrationSection(
  patient: Patient,
  station: OfferedFiles | undefined,
  save: (fields: Readonly<Record<string, unknown>>) => Promise<void>,
  begin: () => void,
): HTMLElement {
  const texts = words.calibrate;
  const file = fieldText(patient, "calibration");
  const device = `${fieldText(patient, "calibration_device")} ${fieldText(patient, "calibration_serial")}`.trim();
  const link = (address: string, text: string) => {
    const made = el("a", { href: address, target: "_blank", rel: "opener" }, text);
    made.addEventListener("click", begin);
    return made;
  };
  const parts: (HTMLElement | null)[] = [
    el("p", {}, file === "" ? texts.none : texts.bound(device === "" ? file : device, fieldText(patient, "calibration_expires") || words.dash)),
    el(
      "div",
      { class: "buttons run-links" },
      link("./?open=calibration", texts.open),
      file === "" ? null : link("./?open=range", texts.openRange),
    ),
    el("p", { class: "hint" }, texts.openHint),
  ];
  if (station?.isNew && station.calibration !== "" && station.calibration !== file) {
    const expires = { name: "calibration_expires", label: texts.expires, kind: "date", hint: words.hints.date, longest: kDateLength } as const;
    const bind = (values: Readonly<Record<string, unknown>>) => save({ ...values, calibration: station.calibration });
    parts.push(el("p", { role: "status" }, texts.uses(station.calibration)), form([expires], { calibration_expires: today() }, texts.bind(patient.code), bind));
  }
  if (station && station.range !== "" && station.range !== fieldText(patient, "range") && file !== "" && station.calibration === file) {
    parts.push(el("p", { role: "status" }, texts.usesRange(station.range)), form([], {}, texts.bindRange(patient.code), () => save({ range: station.range })));
  }
  return section(texts.title, ...parts);
}
