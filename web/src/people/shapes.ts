// SPDX-License-Identifier: Apache-2.0
// What the station answers, read defensively: a field of another kind is as if it were absent.

import { language, textOfFile } from "../strings";

export type Entry = Readonly<Record<string, unknown>>;

export const entry = (value: unknown): Entry => (typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Entry) : {});
export const text = (value: unknown): string => (typeof value === "string" ? value : "");
export const figure = (value: unknown): number | undefined => (typeof value === "number" && Number.isFinite(value) ? value : undefined);
export const list = (value: unknown): readonly unknown[] => (Array.isArray(value) ? (value as unknown[]) : []);
export const texts = (value: unknown): readonly string[] => list(value).map(text).filter((one) => one !== "");

/// A clinical test that is entered by hand, with the values that it allows.
export interface TestKind {
  readonly kind: string;
  readonly unit: string;
  readonly least: number;
  readonly most: number;
}

/// What the page may know before a person signs in.
export interface Status {
  readonly accounts: boolean; // people sign in
  readonly exercises: boolean; // the station can carry them out
  readonly symbols: readonly string[];
  readonly tests: readonly TestKind[];
}

export function readStatus(answer: unknown): Status {
  const one = entry(answer);
  const tests = list(one["tests"]).map(entry).map((test) => ({
    kind: text(test["kind"]), unit: text(test["unit"]), least: figure(test["least"]) ?? 0, most: figure(test["most"]) ?? 0,
  }));
  return { accounts: one["accounts"] === true, exercises: one["exercises"] === true, symbols: texts(one["symbols"]), tests: tests.filter(({ kind }) => kind !== "") };
}

export interface SignedIn {
  readonly session: string; // secret
  readonly account: string;
  readonly role: string;
  readonly idle: number; // after which the station locks the session [s]
}

const kIdle = 600; // [s], as RegistrySettings::idle_lock_s

export function readSignedIn(answer: unknown): SignedIn {
  const one = entry(answer);
  return { session: text(one["session"]), account: text(one["account"]), role: text(one["role"]), idle: figure(one["idle_s"]) ?? kIdle };
}

/// A patient as the list has it.
export interface Listed {
  readonly record: string; // random id
  readonly code: string;
  readonly side: string;
  readonly symbol: string;
  readonly obstacles: readonly string[]; // what the patient lacks for an exercise on this device
}

export interface Prescribed {
  readonly exercise: string;
  readonly repetitions: number; // a day; 0: the exercise's own
  readonly minutes: number; // a day; 0: the exercise's own
  readonly note: string;
}

/// One patient with all fields, by their names in the station's JSON.
export interface Patient extends Listed {
  readonly revision: string; // of the fields: the station refuses a change of others
  readonly said: readonly string[]; // what a change did beyond its fields, in the station's words
  readonly fields: Entry;
}

function readListed(value: unknown): Listed {
  const one = entry(value);
  return { record: text(one["record"]), code: text(one["code"]), side: text(one["side"]), symbol: text(one["symbol"]), obstacles: texts(one["obstacles"]) };
}

export function readPatient(answer: unknown): Patient {
  const fields = entry(answer);
  return { ...readListed(answer), revision: text(fields["revision"]), said: texts(fields["said"]), fields };
}

/// Patients that cannot be read; the others stay in use.
export interface Unreadable {
  readonly damaged: readonly string[]; // record numbers
  readonly withoutKey: number; // patients whose key is missing
}

export const readUnreadable = (answer: unknown): Unreadable => ({ damaged: texts(entry(answer)["damaged"]), withoutKey: figure(entry(answer)["without_key"]) ?? 0 });

export function readPatients(answer: unknown): readonly Listed[] {
  const patients = list(entry(answer)["patients"]).map(readListed).filter(({ record }) => record !== "");
  return patients.sort((a, b) => a.code.localeCompare(b.code));
}

export const fieldText = (patient: Patient, name: string): string => text(patient.fields[name]);
export const fieldLines = (patient: Patient, name: string): readonly string[] => texts(patient.fields[name]);
export const fieldFigure = (patient: Patient, name: string): number | undefined => figure(patient.fields[name]);
export const fieldFlag = (patient: Patient, name: string): boolean => patient.fields[name] === true;

function readLines(value: unknown): readonly Prescribed[] {
  const all = list(value).map(entry).map((one) => ({
    exercise: text(one["exercise"]), repetitions: figure(one["repetitions_per_day"]) ?? 0, minutes: figure(one["minutes_per_day"]) ?? 0, note: text(one["note"]),
  }));
  return all.filter(({ exercise }) => exercise !== "");
}

export const prescription = (patient: Patient): readonly Prescribed[] => readLines(patient.fields["prescription"]);

/// The lines of the prescription as the station's JSON has them.
export const prescribedRows = (patient: Patient): readonly Entry[] => list(patient.fields["prescription"]).map(entry);

/// The same with other values in the line of an exercise. @param values  undefined: without the line
export function otherPrescription(patient: Patient, exercise: string, values: Entry | undefined): readonly Entry[] {
  return prescribedRows(patient).flatMap((row) => (row["exercise"] !== exercise ? [row] : values ? [{ ...row, ...values }] : []));
}

/// Values of a key of each prescribed exercise, which this page does not change.
export function overridesOf(patient: Patient, exercise: string): Entry {
  return entry(prescribedRows(patient).find((one) => one["exercise"] === exercise)?.["overrides"]);
}

export interface EntryCheck {
  readonly flexion: number; // [deg]
  readonly release: number; // [deg]
  readonly date: string;
}

export function entryCheck(patient: Patient): EntryCheck | undefined {
  const one = entry(patient.fields["entry"]);
  const flexion = figure(one["flexion_deg"]);
  return flexion === undefined ? undefined : { flexion, release: figure(one["release_deg"]) ?? 0, date: text(one["date"]) };
}

/// Largest own force of each digit [N]; 0: not measured.
export const ownForces = (patient: Patient): readonly number[] => list(patient.fields["own_force_n"]).map((one) => figure(one) ?? 0);
/// Joints whose own range has been measured.
export const ownRanges = (patient: Patient): number => Object.keys(entry(patient.fields["own_range_deg"])).length;

export interface ScoreValue {
  readonly name: string;
  readonly label: string; // for people, in the language of the page; empty: the station knows none
  readonly unit: string;
  readonly origin: string;
  readonly value: number | undefined;
  readonly invalid: string; // why there is no value
}

export interface Result {
  readonly date: number; // UTC [s]
  readonly exercise: string;
  readonly assessment: boolean;
  readonly scores: readonly ScoreValue[];
  readonly invalid: string; // why none of it counts
  readonly interrupted: boolean;
}

export interface EnteredTest {
  readonly date: string; // UTC, 2026-05-04
  readonly kind: string;
  readonly side: string;
  readonly value: number | undefined;
  readonly unit: string;
  readonly rater: string;
  readonly note: string;
}

export interface Note {
  readonly date: number; // UTC [s]
  readonly account: string;
  readonly text: string;
}

export interface TrendPoint {
  readonly date: number; // UTC [s]
  readonly value: number;
}

/// Values of equal conditions, the oldest first.
export interface Trend {
  readonly name: string;
  readonly title: string;
  readonly unit: string;
  readonly points: readonly TrendPoint[];
  readonly smallest: number | undefined; // smallest real difference that is published for it
  readonly label: string; // of its score, likewise
  readonly entered: boolean; // a test that was entered by hand
  readonly count: number; // values
  readonly first: number;
  readonly last: number;
  readonly proven: boolean;
  readonly verdict: string;
}

/// What was measured and entered of a patient, the newest first.
export interface Course {
  readonly results: readonly Result[];
  readonly tests: readonly EnteredTest[];
  readonly notes: readonly Note[];
  readonly trends: readonly Trend[];
}

/// @param names  of scores for people, by language
const labels = (names: unknown) => (name: string): string => text(entry(entry(names)[name])[language.code]);

/// @param names  of scores for people, as the station's JSON has them
export const scoreReader = (names: unknown) => (row: Entry): ScoreValue => readScore(row, labels(names));

function readScore(row: Entry, label: (name: string) => string): ScoreValue {
  return { name: text(row["name"]), label: label(text(row["name"])), unit: text(row["unit"]), origin: text(row["origin"]), value: figure(row["value"]), invalid: text(row["invalid"]) };
}

function readTrend(row: Entry, label: (name: string) => string): Trend {
  const read = list(row["points"]).map(entry).map((point) => ({ date: figure(point["date"]) ?? NaN, value: figure(point["value"]) ?? NaN }));
  const points = read.filter(({ date, value }) => !Number.isNaN(date) && !Number.isNaN(value)).sort((a, b) => a.date - b.date);
  return {
    name: text(row["name"]), title: text(row["title"]) || text(row["name"]), unit: text(row["unit"]), points, smallest: figure(row["smallest_real_difference"]), label: label(text(row["name"]).split("/")[1] ?? ""),
    entered: row["entered"] === true, count: points.length, first: points[0]?.value ?? NaN, last: points.at(-1)?.value ?? NaN,
    proven: row["proven"] === true, verdict: text(row["verdict"]),
  };
}

export function readCourse(answer: unknown): Course {
  const one = entry(answer);
  const rows = (name: string) => list(one[name]).map(entry);
  const results = rows("results").map((row) => ({
    date: figure(row["date"]) ?? 0, exercise: text(row["exercise"]), assessment: row["assessment"] === true, scores: list(row["scores"]).map(entry).map(scoreReader(one["names"])),
    invalid: text(row["invalid"]), interrupted: row["interrupted"] === true,
  }));
  const tests = rows("tests").map((row) => ({
    date: text(row["date"]), kind: text(row["kind"]), side: text(row["side"]), value: figure(row["value"]), unit: text(row["unit"]), rater: text(row["rater"]),
    note: text(row["note"]),
  }));
  const notes = rows("notes").map((row) => ({ date: figure(row["date"]) ?? 0, account: text(row["account"]), text: text(row["text"]) }));
  return {
    results: results.sort((a, b) => b.date - a.date),
    tests: tests.sort((a, b) => b.date.localeCompare(a.date)),
    notes: notes.sort((a, b) => b.date - a.date),
    trends: rows("trends").map((row) => readTrend(row, labels(one["names"]))),
  };
}

/// What a deletion reached, and what it could not.
export interface Deleted {
  readonly left: readonly string[]; // files that a person must remove
  readonly removed: number; // exports that were deleted
  readonly unreadable: number; // encrypted recordings that are unreadable from now on
  readonly unknown: number; // rows that could not be read: the files that they named are not listed
}

export function readDeleted(answer: unknown): Deleted {
  const one = entry(answer);
  const count = (name: string) => figure(one[name]) ?? list(one[name]).length;
  return {
    left: [...texts(one["exports_missing"]), ...texts(one["plain_recordings"]), ...texts(one["bound_files"])],
    removed: count("exports_removed"), unreadable: count("encrypted_recordings"), unknown: count("unreadable_rows"),
  };
}

/// A person who signs in.
export interface Account {
  readonly name: string;
  readonly role: string;
}

export function readAccounts(answer: unknown): readonly Account[] {
  const all = list(entry(answer)["accounts"]).map(entry).map((one) => ({ name: text(one["name"]), role: text(one["role"]) }));
  return all.filter(({ name }) => name !== "");
}

/// A file of an export.
export interface ExportedFile {
  readonly name: string;
  readonly type: string;
  readonly text: string;
}

export function readExport(answer: unknown): readonly ExportedFile[] {
  const files = list(entry(answer)["files"]).map(entry).map((file) => ({ name: text(file["name"]), type: text(file["type"]), text: text(file["text"]) }));
  return files.filter(({ name }) => name !== "");
}

/// A prescription that is ready for use.
export interface Template {
  readonly name: string;
  readonly title: string;
  readonly titleDe: string; // empty: its file has none
  readonly lines: readonly TemplateLine[];
}

/// A line of a template, with the values of the exercise's keys that it changes.
export interface TemplateLine extends Prescribed {
  readonly overrides: Entry;
}

/// @param german  notes in German, by exercise
function readTemplateLines(value: unknown, german: Entry): readonly TemplateLine[] {
  const named = list(value).map(entry).filter((one) => text(one["exercise"]) !== "");
  const note = ({ exercise, note: plain }: Prescribed) => textOfFile(plain, text(german[exercise]));
  return readLines(named).map((line, i) => ({ ...line, note: note(line), overrides: entry(named[i]?.["overrides"]) }));
}

export function readTemplates(answer: unknown): readonly Template[] {
  const all = list(entry(answer)["templates"]).map(entry).map((one) => ({ name: text(one["name"]), title: text(one["title"]) || text(one["name"]), titleDe: text(one["title_de"]), lines: readTemplateLines(one["lines"], entry(one["notes_de"])) }));
  return all.filter(({ name }) => name !== "");
}

export interface Exercise {
  readonly name: string;
  readonly title: string;
  readonly titleDe: string; // empty: its file has none
  readonly kind: string;
  readonly measure: string;
}

export function readExercises(answer: unknown): readonly Exercise[] {
  const all = list(entry(answer)["exercises"]).map(entry).map((row) => ({
    name: text(row["name"]), title: text(row["title"]) || text(row["name"]), titleDe: text(row["title_de"]), kind: text(row["kind"]), measure: text(row["measure"]),
  }));
  return all.filter(({ name }) => name !== "");
}
