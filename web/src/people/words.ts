// SPDX-License-Identifier: Apache-2.0
// The texts of the page of patients in the language in use, and values of a patient as text.
import { english, language, strings, textOfFile } from "../strings";
import { de as exerciseDe } from "../strings/exercise_de";
import { en as exerciseEn, type ExerciseStrings } from "../strings/exercise_en";
import { de as faultsDe } from "../strings/faults_de";
import { de } from "../strings/people_de";
import { en, type PeopleStrings } from "../strings/people_en";
import type { Exercise, ScoreValue, Trend } from "./shapes";

/// By the code of the language.
export const peopleLanguages: Readonly<Record<string, PeopleStrings>> = { en, de };

/// The language of the station's own words.
export const stationLanguage = english.code;

export const words: PeopleStrings = peopleLanguages[language.code] ?? en;

const exerciseLanguages: Readonly<Record<string, ExerciseStrings>> = { en: exerciseEn, de: exerciseDe };
/// What the participant of an exercise is told, as on the patient's screen.
export const exerciseTexts: ExerciseStrings = exerciseLanguages[language.code] ?? exerciseEn;

/// Meaning and remedy of a fault by its name, by the code of the language; the station's own words are in none of them.
export const faultLanguages: Readonly<Record<string, Readonly<Record<string, string>>>> = { de: faultsDe };

/// The title of an exercise in the language of the page, if its file has it.
export const titleText = ({ title, titleDe }: { readonly title: string; readonly titleDe: string }): string => textOfFile(title, titleDe);

/// 1 Dec 2026, 14:03, of this browser's clock; a dash where no date is known.
export function timeText(unixSeconds: number): string {
  if (!(unixSeconds > 0)) return words.dash;
  return new Date(unixSeconds * 1000).toLocaleString(strings.figures, { dateStyle: "medium", timeStyle: "short", hourCycle: "h23" });
}

/// At most 4 significant digits.
export function figureText(value: number | undefined): string {
  return value === undefined || !Number.isFinite(value) ? words.dash : value.toLocaleString(strings.figures, { maximumSignificantDigits: 4, useGrouping: false });
}

export function valueText(value: number | undefined, unit: string): string {
  return value === undefined || unit === "" || unit === "-" ? figureText(value) : `${figureText(value)} ${unit}`;
}

/// With its sign.
export function changeText(value: number, unit: string): string {
  return value > 0 ? `+${valueText(value, unit)}` : valueText(value, unit);
}

/// 4 May 2026, of this browser's clock.
export const dayText = (unixSeconds: number): string => new Date(unixSeconds * 1000).toLocaleDateString(strings.figures, { dateStyle: "medium" });
/// 4 May 26, for the axis of a chart.
export const axisDay = (unixSeconds: number): string => new Date(unixSeconds * 1000).toLocaleDateString(strings.figures, { day: "numeric", month: "short", year: "2-digit" });
/// 2026-05-04, of the station's calendar, which is UTC; empty where no date is known.
export const dayName = (unixSeconds: number): string => (unixSeconds > 0 ? new Date(unixSeconds * 1000).toISOString().slice(0, 10) : "");

/// The title of an exercise by its name, among those that there are.
export function titleOf(exercises: readonly Exercise[], name: string): string {
  const known = exercises.find((one) => one.name === name);
  return known ? titleText(known) : name.replaceAll("_", " ");
}

/// The name of a score for people. One that the station does not know is in its own words, without its unit, which follows its value: "mean_n"
/// is "mean".
export function scoreName({ name, label, unit }: Pick<ScoreValue, "name" | "label" | "unit">): string {
  if (label !== "") return label;
  const parts = name.split("_");
  if (parts.length > 1 && parts.at(-1) === unit.toLowerCase()) parts.pop();
  return parts.join(" ");
}

/// What a trend is of, in the language of the page where it is a test that was entered.
export function trendTitle({ name, title, label, unit, entered }: Trend, exercises: readonly Exercise[]): string {
  const [kind = "", side = ""] = name.split("/");
  if (entered && words.kinds[kind] !== undefined) return `${words.kinds[kind]}, ${words.testSides[side] ?? side}`;
  return entered || side === "" ? title : `${titleOf(exercises, kind)}: ${scoreName({ name: side, label, unit })}`;
}

/// The station's verdict in short, in the language of the page; its own words where they begin in no known way.
export function verdictText({ verdict }: Trend): string {
  const found = Object.entries(words.verdicts).find(([begin]) => verdict.startsWith(begin));
  return found ? found[1] : verdict;
}
