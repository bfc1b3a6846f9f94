// SPDX-License-Identifier: Apache-2.0
// The way into an exercise: one button for each that is prescribed, a choice of any other, and before it begins the one question that must be
// right: whether the hand in the device is of this patient and of this side.
import { ChoiceBox } from "../panels/choice_box";
import { button, el, newId, section, setShown, setText } from "../panels/dom";
import { chips } from "./chips";
import { form } from "./form";
import { obstacleTexts, sideText, symbolText } from "./lists";
import { fieldLines, otherPrescription, prescribedRows, prescription, type Exercise, type Patient, type Prescribed } from "./shapes";
import { picture } from "./symbols";
import { refusalText } from "./trouble";
import { figureText, titleOf, titleText, words } from "./words";

/// Codes that begin with it are of simulated patients.
const kSimulated = "SIM";
export const isSimulated = ({ code }: Patient): boolean => code.startsWith(kSimulated);

export const handText = ({ side }: { readonly side: string }): string => words.begin.hand[side] ?? side;

export function doseText({ repetitions, minutes, note }: Prescribed): string {
  const parts = [repetitions > 0 ? words.patient.repetitions(String(repetitions)) : "", minutes > 0 ? words.patient.minutes(figureText(minutes)) : "", note];
  return parts.filter((part) => part !== "").join(", ");
}

export interface BeginActions {
  begin(exercise: string): void;
  change(fields: Readonly<Record<string, unknown>>): Promise<void>;
}

const doseOf = ({ repetitions, minutes, note }: Prescribed) => ({ repetitions: repetitions > 0 ? repetitions : undefined, minutes: minutes > 0 ? minutes : undefined, note });

/// Dose and remark of one line of a prescription, and its removal.
function doseForm(patient: Patient, line: Prescribed, change: BeginActions["change"]): HTMLElement {
  const texts = words.begin;
  const plans = [
    { name: "repetitions", label: texts.repetitions, kind: "number" },
    { name: "minutes", label: texts.minutes, kind: "number", unit: "min" },
    { name: "note", label: words.fields["note"] ?? "", kind: "text" },
  ] as const;
  const save = ({ repetitions, minutes, note }: Readonly<Record<string, unknown>>) => {
    for (const [value, label] of [[repetitions, texts.repetitions], [minutes, texts.minutes]] as const) if (Number.isNaN(value)) throw new Error(words.patient.badNumber(label));
    return change({ prescription: otherPrescription(patient, line.exercise, { repetitions_per_day: repetitions ?? 0, minutes_per_day: minutes ?? 0, note }) });
  };
  const remove = form([], {}, texts.remove, () => change({ prescription: otherPrescription(patient, line.exercise, undefined) }));
  return el("details", {}, el("summary", {}, texts.dose), form(plans, doseOf(line), words.save, save), remove);
}

function card(patient: Patient, line: Prescribed, exercises: readonly Exercise[], { begin, change }: BeginActions): HTMLElement {
  const known = exercises.find(({ name }) => name === line.exercise);
  const title = titleOf(exercises, line.exercise);
  const kind = known ? (words.exerciseKinds[known.kind] ?? known.kind) : "";
  return el(
    "li",
    { class: "begin-card" },
    el("div", {}, el("strong", {}, title), el("small", {}, [kind, doseText(line)].filter((part) => part !== "").join(" · "))),
    button(words.begin.begin, () => begin(line.exercise), { class: "primary", "aria-label": `${words.begin.begin}: ${title}` }),
    doseForm(patient, line, change),
  );
}

/// @param templates  what stands there where nothing is prescribed
export function beginSection(patient: Patient, exercises: readonly Exercise[], templates: HTMLElement, actions: BeginActions): HTMLElement {
  const lines = prescription(patient);
  const isPrescribed = (name: string) => lines.some(({ exercise }) => exercise === name);
  const other = new ChoiceBox(() => {
    go.disabled = other.value === "";
    add.disabled = other.value === "" || isPrescribed(other.value);
  });
  other.name(words.begin.other);
  other.setChoices([{ value: "", text: words.begin.choose }, ...exercises.map((one) => ({ value: one.name, text: `${titleText(one)} (${words.exerciseKinds[one.kind] ?? one.kind})` }))]);
  other.value = "";
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const go = button(words.begin.begin, () => actions.begin(other.value), { "aria-label": `${words.begin.begin}: ${words.begin.other}`, disabled: true });
  const add = button(words.begin.prescribe, () => {
    add.disabled = true;
    setShown(refused, false);
    const line = { exercise: other.value, repetitions_per_day: 0, minutes_per_day: 0, note: "", overrides: {} };
    void actions.change({ prescription: [...prescribedRows(patient), line] }).catch((reason: unknown) => {
      setText(refused, refusalText(reason));
      setShown(refused, true);
      add.disabled = false;
    });
  }, { disabled: true });
  return section(
    words.begin.title,
    lines.length > 0 ? el("ul", { class: "begin-cards" }, ...lines.map((line) => card(patient, line, exercises, actions))) : el("p", { class: "hint" }, words.begin.nothing),
    lines.length > 0 ? null : templates,
    el("div", { class: "field begin-other" }, el("span", { class: "quiet-text", "aria-hidden": "true" }, words.begin.other), el("div", { class: "begin-row" }, el("div", {}, other.button, other.list), go, add)),
    refused,
    lines.length > 0 ? el("details", {}, el("summary", {}, words.templates.title), templates) : null,
  );
}

/// @param begin  gets the skill of a simulated participant; empty: a person, or a simulated device's own hand. What it throws is shown
export function confirmPanel(patient: Patient, exercise: Exercise, begin: (demo: string) => Promise<void>, cancel: () => void): HTMLElement {
  const id = newId("confirm");
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const simulated = isSimulated(patient);
  const ofDevice = { value: "", text: words.begin.device }; // no simulated participant: the device moves its own hand
  const skills = [...Object.entries(words.begin.skills).map(([value, text]) => ({ value, text })), ofDevice];
  const doer = simulated ? chips(words.begin.doer, skills, skills[0]?.value ?? "") : undefined;
  const yes = button(words.begin.confirm(patient.code, sideText(patient)), () => {
    if (yes.disabled) return;
    yes.disabled = true;
    setShown(refused, false);
    void begin(doer?.value ?? "")
      .catch((reason: unknown) => {
        setText(refused, refusalText(reason));
        setShown(refused, true);
      })
      .finally(() => (yes.disabled = false));
  }, { class: "primary confirm-yes" });
  const against = [...obstacleTexts(patient), ...fieldLines(patient, "contraindications"), ...fieldLines(patient, "warnings")];
  return el(
    "section",
    { class: "people-box people-patient confirm", "aria-labelledby": id },
    el("h2", { id, tabindex: -1 }, simulated ? words.begin.simulated : words.begin.who),
    el("div", { class: "confirm-who" }, picture(patient.symbol), el("div", {}, el("strong", {}, patient.code), el("span", {}, handText(patient)), el("span", {}, symbolText(patient)))),
    el("p", { class: "run-title" }, titleText(exercise)),
    against.length > 0 ? el("ul", { class: "patient-told" }, ...against.map((text) => el("li", { class: "refused" }, text))) : null,
    doer?.element,
    refused,
    el("div", { class: "buttons" }, yes, button(words.cancel, cancel)),
    el("p", { class: "hint" }, words.begin.resists),
  );
}
