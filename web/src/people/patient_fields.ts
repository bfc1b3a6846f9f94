// SPDX-License-Identifier: Apache-2.0
// The fields of a patient that a person fills in, and what is measured. The station checks all values.
import { strings } from "../strings";
import type { FieldPlan } from "./form";
import { entryCheck, fieldFigure, fieldFlag, fieldLines, fieldText, overridesOf, ownForces, ownRanges, prescription, type Patient, type Prescribed, type Status, type Template } from "./shapes";
import { templateLines, templateName } from "./templates";
import { figureText, valueText, words } from "./words";

const { newton, degree, stiffness, torque } = strings.units;
const kCodeLength = 16;
const kDateLength = 10;
const kNoteLength = 4000;
const kTemplate = "template"; // of the form of a new patient; the station has no such field

/// measured: the station takes it from a file; the form has no field for it.
type Plan = Omit<FieldPlan, "label"> & { readonly measured?: true };

const plans: readonly Plan[] = [
  { name: "code", kind: "text", hint: words.hints.code, longest: kCodeLength },
  { name: "side", kind: "chips" },
  { name: "symbol", kind: "choice" },
  { name: "consent", kind: "flag" },
  { name: "consent_date", kind: "date", hint: words.hints.date, longest: kDateLength },
  { name: "profile", kind: "text" },
  { name: "calibration", kind: "text" },
  { name: "calibration_device", kind: "text", measured: true },
  { name: "calibration_serial", kind: "text", measured: true },
  { name: "calibration_method", kind: "text", measured: true },
  { name: "calibration_expires", kind: "date", hint: words.hints.date, longest: kDateLength },
  { name: "range", kind: "text" },
  { name: "force_limit_n", kind: "number", unit: newton },
  { name: "stiffness_limit_n_per_mm", kind: "number", unit: stiffness },
  { name: "torque_limit_nm", kind: "number", unit: torque },
  { name: "contraindications", kind: "lines", hint: words.hints.lines },
  { name: "warnings", kind: "lines", hint: words.hints.lines },
  { name: "prescription", kind: "lines", hint: words.hints.prescription },
  { name: "note", kind: "area", longest: kNoteLength },
];

const typed = plans.filter(({ measured }) => !measured);

const label = (name: string): string => words.fields[name] ?? name;

/// What a new patient needs; all other fields are folded away.
const firstFields: readonly string[] = ["code", "side", "consent", kTemplate];

/// The fields of the form, with the symbols that may be chosen.
/// @param templates  of prescriptions  @param isNew  no side is proposed, since a wrong one would put the wrong hand into these limits
export function patientPlans(status: Status, templates: readonly Template[], isNew: boolean): readonly FieldPlan[] {
  const choices: Readonly<Record<string, FieldPlan["choices"]>> = {
    side: Object.entries(words.sides).map(([value, text]) => ({ value, text })),
    symbol: [...(isNew ? [{ value: "", text: words.list.automatic }] : []), ...status.symbols.map((value) => ({ value, text: words.symbols[value] ?? value }))],
  };
  const all = typed.map((plan): FieldPlan => {
    const chosen = choices[plan.name];
    return { ...plan, label: label(plan.name), ...(chosen ? { choices: chosen } : {}), later: isNew && !firstFields.includes(plan.name) };
  });
  if (!isNew || templates.length === 0) return all;
  const named = templates.map((one) => ({ value: one.name, text: templateName(one) }));
  const template: FieldPlan = { name: kTemplate, label: words.templates.label, kind: "chips", choices: [{ value: "", text: words.templates.none }, ...named] };
  const at = all.findIndex(({ name }) => name === "consent") + 1;
  return [...all.slice(0, at), template, ...all.slice(at)];
}

// ---- prescription: one exercise on each line, "press_and_hold; 20; 10; slowly"

function prescribedLine({ exercise, repetitions, minutes, note }: Prescribed): string {
  const parts = [exercise, repetitions > 0 ? String(repetitions) : "", minutes > 0 ? String(minutes) : "", note];
  while (parts.at(-1) === "") parts.pop();
  return parts.join("; ");
}

/// @returns the line in the form of the station's JSON; a number that cannot be read becomes NaN
function readLine(line: string, patient: Patient | undefined): Readonly<Record<string, unknown>> {
  const [exercise = "", repetitions = "", minutes = "", ...note] = line.split(";").map((part) => part.trim());
  const overrides = patient ? overridesOf(patient, exercise) : {};
  return { exercise, repetitions_per_day: Number(repetitions), minutes_per_day: Number(minutes.replace(",", ".")), note: note.join("; "), overrides };
}

// ---- between the form and the station's JSON

/// The form's values of a patient.
export function formValues(patient: Patient): Readonly<Record<string, unknown>> {
  const read: Readonly<Record<FieldPlan["kind"], (name: string) => unknown>> = {
    text: (name) => fieldText(patient, name),
    secret: () => "", // no field of a patient is one
    area: (name) => fieldText(patient, name),
    date: (name) => fieldText(patient, name),
    choice: (name) => fieldText(patient, name),
    chips: (name) => fieldText(patient, name),
    number: (name) => fieldFigure(patient, name),
    flag: (name) => fieldFlag(patient, name),
    lines: (name) => (name === "prescription" ? prescription(patient).map(prescribedLine) : fieldLines(patient, name)),
  };
  return Object.fromEntries(typed.map(({ name, kind }) => [name, read[kind](name)]));
}

/// The fields that differ from those that the form began with: what another person changes meanwhile is not sent back.
function differing(values: Readonly<Record<string, unknown>>, patient: Patient | undefined): Record<string, unknown> {
  if (!patient) return { ...values };
  const before = formValues(patient);
  const same = (name: string) => JSON.stringify(values[name] ?? null) === JSON.stringify(before[name] ?? null);
  return Object.fromEntries(Object.entries(values).filter(([name]) => !same(name)));
}

/// The changes that a filled form makes, in the form of the station's JSON. A template is the prescription, followed by the lines that were
/// typed. @throws Error naming a number that cannot be read
export function formChanges(filled: Readonly<Record<string, unknown>>, patient: Patient | undefined, templates: readonly Template[] = []): Readonly<Record<string, unknown>> {
  const { [kTemplate]: template, ...values } = filled;
  const changes = differing(values, patient);
  const lines = Array.isArray(values["prescription"]) ? (values["prescription"] as unknown[]).map(String) : [];
  const prescribed = lines.map((line) => readLine(line, patient));
  lines.forEach((line, i) => {
    const { repetitions_per_day: repetitions, minutes_per_day: minutes } = prescribed[i]!;
    if (Number.isNaN(repetitions) || Number.isNaN(minutes)) throw new Error(words.patient.badLine(line));
  });
  if (values["side"] === "") throw new Error(words.patient.noSide);
  for (const { name, kind } of typed) if (kind === "number" && Number.isNaN(values[name])) throw new Error(words.patient.badNumber(label(name)));
  const chosen = templates.find(({ name }) => name === template);
  return "prescription" in changes ? { ...changes, prescription: [...(chosen ? templateLines(chosen) : []), ...prescribed] } : changes;
}

/// What is known of a patient, a label and a text each. What is absent is left out.
export function facts(patient: Patient): readonly (readonly [string, string])[] {
  const texts: (readonly [string, string])[] = [];
  const add = (name: string, text: string) => {
    if (text !== "") texts.push([label(name), text]);
  };
  for (const { name, kind, unit } of plans) {
    if (name === "code" || name === "side" || name === "symbol") continue; // in the head
    if (kind === "flag") add(name, fieldFlag(patient, name) ? words.yes : words.no);
    else if (name === "prescription") add(name, prescription(patient).map(prescriptionText).join("\n"));
    else if (kind === "lines") add(name, fieldLines(patient, name).join("\n"));
    else if (kind === "number") add(name, fieldFigure(patient, name) === undefined ? "" : valueText(fieldFigure(patient, name), unit ?? ""));
    else add(name, fieldText(patient, name));
  }
  const check = entryCheck(patient);
  if (check) add("entry", words.patient.entry(valueText(check.flexion, degree), valueText(check.release, degree), check.date));
  const forces = ownForces(patient).flatMap((force, digit) => (force > 0 ? [`${strings.digits[digit] ?? digit} ${valueText(force, newton)}`] : []));
  add("own_force_n", forces.join(", "));
  add("own_range_deg", ownRanges(patient) > 0 ? words.patient.joints(String(ownRanges(patient))) : "");
  return texts;
}

function prescriptionText({ exercise, repetitions, minutes, note }: Prescribed): string {
  const dose = [repetitions > 0 ? words.patient.repetitions(String(repetitions)) : "", minutes > 0 ? words.patient.minutes(figureText(minutes)) : "", note];
  return [exercise, ...dose.filter((part) => part !== "")].join(", ");
}
