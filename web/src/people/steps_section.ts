// SPDX-License-Identifier: Apache-2.0
// What is measured before a patient trains: entry check, own force, own range. Each is an exercise; what was measured elsewhere is entered.
import { strings } from "../strings";
import { button, el, section } from "../panels/dom";
import { today } from "./calibration_section";
import { form } from "./form";
import { entryCheck, ownForces, ownRanges, type Exercise, type Patient } from "./shapes";
import { valueText, words } from "./words";

const { newton, degree } = strings.units;
const kDateLength = 10;

export interface StepActions {
  /// absent: the station carries out no exercises
  readonly begin: ((exercise: string) => void) | undefined;
  change(fields: Readonly<Record<string, unknown>>): Promise<void>;
}

interface Step {
  readonly label: string;
  readonly state: string;
  readonly isDone: boolean;
  readonly measure: string; // of the exercise that measures it
  readonly enter: HTMLElement | null;
}

/// @throws Error naming a number that is missing or cannot be read
function number(values: Readonly<Record<string, unknown>>, name: string, label: string): number {
  const value = values[name];
  if (typeof value !== "number" || Number.isNaN(value)) throw new Error(words.patient.badNumber(label));
  return value;
}

function entryStep(patient: Patient, change: StepActions["change"]): Step {
  const texts = words.steps;
  const known = entryCheck(patient);
  const suits = !patient.obstacles.includes("unsuitable");
  const found = known ? words.patient.entry(valueText(known.flexion, degree), valueText(known.release, degree), known.date) : "";
  const plans = [
    { name: "flexion", label: texts.flexion, kind: "number", unit: degree },
    { name: "release", label: texts.release, kind: "number", unit: degree },
    { name: "date", label: texts.date, kind: "date", hint: words.hints.date, longest: kDateLength },
  ] as const;
  const save = (values: Readonly<Record<string, unknown>>) =>
    change({ entry: { flexion_deg: number(values, "flexion", texts.flexion), release_deg: number(values, "release", texts.release), date: values["date"] } });
  const before = { flexion: known?.flexion, release: known?.release, date: today() };
  return {
    label: words.fields["entry"] ?? "", isDone: known !== undefined && suits, measure: "entry_check", enter: form(plans, before, words.save, save),
    state: known ? (suits ? found : `${found}. ${words.obstacles["unsuitable"] ?? ""}`) : texts.missing,
  };
}

function forceStep(patient: Patient, change: StepActions["change"]): Step {
  const forces = ownForces(patient);
  const known = forces.flatMap((force, digit) => (force > 0 ? [`${strings.digits[digit] ?? digit} ${valueText(force, newton)}`] : []));
  const plans = strings.digits.map((label, digit) => ({ name: String(digit), label, kind: "number", unit: newton }) as const);
  const before = Object.fromEntries(forces.flatMap((force, digit) => (force > 0 ? [[String(digit), force]] : [])));
  const save = (values: Readonly<Record<string, unknown>>) => {
    const own = strings.digits.map((label, digit) => (values[String(digit)] === null ? 0 : number(values, String(digit), label)));
    return change({ own_force_n: own });
  };
  return { label: words.fields["own_force_n"] ?? "", state: known.join(", ") || words.steps.missing, isDone: known.length > 0, measure: "own_force", enter: form(plans, before, words.save, save) };
}

function rangeStep(patient: Patient): Step {
  const count = ownRanges(patient);
  return { label: words.fields["own_range_deg"] ?? "", state: count > 0 ? words.patient.joints(String(count)) : words.steps.missing, isDone: count > 0, measure: "range_of_motion", enter: null };
}

function row({ label, state, isDone, measure, enter }: Step, exercises: readonly Exercise[], begin: StepActions["begin"]): HTMLElement {
  const exercise = exercises.find((one) => one.measure === measure && one.kind === "assessment");
  const text = isDone ? words.steps.again : words.steps.measure;
  const press = exercise && begin ? button(text, () => begin(exercise.name), { class: isDone ? undefined : "primary", "aria-label": `${text}: ${label}` }) : null;
  return el(
    "li",
    { class: "step", "data-done": String(isDone) },
    el("div", { class: "step-what" }, el("strong", {}, label), el("span", { class: "quiet-text" }, state)),
    press,
    enter ? el("details", {}, el("summary", { "aria-label": `${words.steps.enter}: ${label}` }, words.steps.enter), enter) : null,
  );
}

/// @param exercises  that there are
export function stepsSection(patient: Patient, exercises: readonly Exercise[], { begin, change }: StepActions): HTMLElement {
  const steps = [entryStep(patient, change), forceStep(patient, change), rangeStep(patient)];
  const list = el("ul", { class: "steps" }, ...steps.map((one) => row(one, exercises, begin)));
  const { title, hint } = words.steps;
  if (steps.every(({ isDone }) => isDone)) return el("details", { class: "steps-done" }, el("summary", {}, title), list);
  return section(title, el("p", { class: "hint" }, hint), list);
}
