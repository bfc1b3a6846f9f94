// SPDX-License-Identifier: Apache-2.0
// The texts of the page of patients in the language in use, and values of a patient as text.
import { language, strings } from "../strings";
import { de } from "../strings/people_de";
import { en, type PeopleStrings } from "../strings/people_en";

/// By the code of the language.
export const peopleLanguages: Readonly<Record<string, PeopleStrings>> = { en, de };

export const words: PeopleStrings = peopleLanguages[language.code] ?? en;

/// 1 Dec 2026, 14:03, of this browser's clock; a dash where no date is known.
export function timeText(unixSeconds: number): string {
  if (!(unixSeconds > 0)) return words.dash;
  return new Date(unixSeconds * 1000).toLocaleString(strings.figures, { dateStyle: "medium", timeStyle: "short", hourCycle: "h23" });
}

/// At most 4 significant digits.
export function figureText(value: number | undefined): string {
  return value === undefined || !Number.isFinite(value) ? words.dash : String(Number(value.toPrecision(4)));
}

export function valueText(value: number | undefined, unit: string): string {
  return value === undefined || unit === "" || unit === "-" ? figureText(value) : `${figureText(value)} ${unit}`;
}

/// With its sign.
export function changeText(value: number, unit: string): string {
  return value > 0 ? `+${valueText(value, unit)}` : valueText(value, unit);
}
