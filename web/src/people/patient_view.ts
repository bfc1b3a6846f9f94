// SPDX-License-Identifier: Apache-2.0
// One patient: who it is, what keeps the patient from exercises, the fields, and the course.
import { button, el, newId, section } from "../panels/dom";
import { beginSection } from "./begin_exercise";
import type { CalibrationOffer } from "./calibration_offer";
import { calibrationSection } from "./calibration_section";
import { notesSection, resultsSection, testsSection, trendsSection } from "./course_sections";
import { documentsSection, type DocumentActions, type ReportWindows } from "./documents";
import { form } from "./form";
import { facts, formChanges, formValues, patientPlans } from "./patient_fields";
import { obstacleTexts, sideText, symbolText } from "./lists";
import { fieldLines, prescription, type Course, type Deleted, type Exercise, type Patient, type Status, type Template } from "./shapes";
import { stepsSection } from "./steps_section";
import { picture } from "./symbols";
import { templateLines, templateList } from "./templates";
import { words } from "./words";

export interface PatientActions extends DocumentActions {
  edit(): void;
  back(): void;
  begin(exercise: string): void;
  calibrate(): void; // the cockpit's dialog is opened
  change(fields: Readonly<Record<string, unknown>>): Promise<void>;
  addTest(test: Readonly<Record<string, unknown>>): Promise<void>;
  addNote(text: string): Promise<void>;
  remove(confirm: string): Promise<void>;
}

function factList(patient: Patient): HTMLElement {
  const rows = facts(patient).flatMap(([label, text]) => [el("dt", {}, label), el("dd", {}, text)]);
  return el("dl", { class: "facts" }, ...rows);
}

/// What a person has to know before this patient's hand is in the device.
function told(patient: Patient): HTMLElement {
  const against = [...obstacleTexts(patient), ...fieldLines(patient, "contraindications"), ...fieldLines(patient, "warnings")];
  if (against.length === 0) return el("p", { class: "patient-good" }, words.patient.ready);
  return el("ul", { class: "patient-told" }, ...against.map((text) => el("li", { class: "refused" }, text)));
}

function head(patient: Patient, back: () => void): HTMLElement {
  const id = newId("patient");
  return el(
    "header",
    { class: "patient-head" },
    picture(patient.symbol),
    el("h2", { id, tabindex: -1 }, patient.code),
    el("p", { class: "patient-who" }, `${sideText(patient)}, ${symbolText(patient)}`),
    button(words.back, back, { class: "people-back" }),
  );
}

function removal(patient: Patient, remove: (confirm: string) => Promise<void>): HTMLElement {
  const plan = { name: "confirm", label: words.remove.confirm(patient.code), kind: "text", longest: 16 } as const;
  return el(
    "details",
    { class: "patient-remove" },
    el("summary", {}, words.remove.title),
    el("p", { class: "hint" }, words.remove.hint),
    form([plan], {}, words.remove.submit, (values) => remove(String(values["confirm"]))),
  );
}

/// What the views of a patient need besides the patient.
export interface PatientContext {
  readonly status: Status;
  readonly exercises: readonly Exercise[]; // that there are
  readonly templates: readonly Template[];
  readonly offer: CalibrationOffer; // of what a cockpit of this browser has made
  readonly windows: ReportWindows;
}

/// @param course  absent: it is still being read
export function patientView(patient: Patient, context: PatientContext, course: Course | undefined, actions: PatientActions): HTMLElement {
  const { status, exercises, templates, offer, windows } = context;
  const use = (template: Template) => actions.change({ prescription: templateLines(template) });
  const list = templateList(templates, exercises, prescription(patient).length > 0, use);
  const parts = course
    ? [
        trendsSection(course, exercises), resultsSection(course, exercises), testsSection(course, status.tests, actions.addTest), notesSection(course, actions.addNote),
        documentsSection(patient, course, windows, actions),
      ]
    : [el("p", { class: "hint", role: "status" }, words.reading)];
  return el(
    "section",
    { class: "people-box people-patient", "aria-label": words.patient.region(patient.code) },
    head(patient, actions.back),
    told(patient),
    stepsSection(patient, exercises, { begin: status.exercises ? actions.begin : undefined, change: actions.change }),
    status.exercises ? beginSection(patient, exercises, list, actions) : null,
    ...parts,
    calibrationSection(patient, offer.of(patient.record), actions.change, actions.calibrate),
    section(words.patient.facts, factList(patient), el("div", { class: "buttons" }, button(words.patient.edit, actions.edit))),
    removal(patient, actions.remove),
  );
}

/// The form of a new patient, or of one that is changed.
export function patientForm(
  patient: Patient | undefined,
  { status, templates }: PatientContext,
  save: (fields: Readonly<Record<string, unknown>>) => Promise<void>,
  cancel: () => void,
): HTMLElement {
  const id = newId("patient-form");
  const title = patient ? `${words.patient.edit}: ${patient.code}` : words.patient.newOne;
  return el(
    "section",
    { class: "people-box people-patient", "aria-labelledby": id },
    el("h2", { id, tabindex: -1 }, title),
    el("p", { class: "hint" }, words.patient.noNames),
    form(patientPlans(status, templates, !patient), patient ? formValues(patient) : {}, words.save, (values) => save(formChanges(values, patient, templates)), cancel),
  );
}

/// What a deletion did, and which files a person must still delete.
export function deletedReport({ left, removed, unreadable, unknown }: Deleted): HTMLElement {
  const files = el("ul", {}, ...left.map((file) => el("li", {}, el("code", {}, file))));
  const counted = ([[unreadable, words.remove.unreadable], [removed, words.remove.removed], [unknown, words.remove.unknown]] as const).filter(([count]) => count > 0);
  return el(
    "div",
    { class: "people-box people-patient", role: "status" },
    el("p", {}, words.remove.done),
    ...counted.map(([count, text]) => el("p", { class: "hint" }, text(String(count)))),
    ...(left.length > 0 ? [el("p", {}, words.remove.left), files] : []),
  );
}
