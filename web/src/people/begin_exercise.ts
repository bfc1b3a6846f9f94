// SPDX-License-Identifier: Apache-2.0
// The way into an exercise: one button for each that is prescribed, a choice of any other, and before it begins the one question that must be
// right: whether the hand in the device is of this patient and of this side.
import { ChoiceBox } from "../panels/choice_box";
import { button, el, newId, section, setShown, setText } from "../panels/dom";
import { chips } from "./chips";
import { obstacleTexts, sideText, symbolText } from "./lists";
import { fieldLines, prescription, type Exercise, type Patient, type Prescribed } from "./shapes";
import { picture } from "./symbols";
import { refusalText } from "./trouble";
import { figureText, stationLanguage, words } from "./words";

/// Codes that begin with it are of simulated patients.
const kSimulated = "SIM";
export const isSimulated = ({ code }: Patient): boolean => code.startsWith(kSimulated);

export const handText = ({ side }: { readonly side: string }): string => words.begin.hand[side] ?? side;

export function doseText({ repetitions, minutes, note }: Prescribed): string {
  const parts = [repetitions > 0 ? words.patient.repetitions(String(repetitions)) : "", minutes > 0 ? words.patient.minutes(figureText(minutes)) : "", note];
  return parts.filter((part) => part !== "").join(", ");
}

function card(line: Prescribed, exercises: readonly Exercise[], begin: () => void): HTMLElement {
  const known = exercises.find(({ name }) => name === line.exercise);
  const title = known?.title ?? line.exercise;
  const kind = known ? (words.exerciseKinds[known.kind] ?? known.kind) : "";
  return el(
    "li",
    { class: "begin-card" },
    el("div", {}, el("strong", { lang: known ? stationLanguage : undefined }, title), el("small", {}, [kind, doseText(line)].filter((part) => part !== "").join(" · "))),
    button(words.begin.begin, begin, { class: "primary", "aria-label": `${words.begin.begin}: ${title}` }),
  );
}

/// @param templates  what stands there where nothing is prescribed
export function beginSection(patient: Patient, exercises: readonly Exercise[], templates: HTMLElement, begin: (exercise: string) => void): HTMLElement {
  const lines = prescription(patient);
  const other = new ChoiceBox(() => (go.disabled = other.value === ""));
  other.name(words.begin.other);
  other.setChoices([{ value: "", text: words.begin.choose }, ...exercises.map(({ name, title, kind }) => ({ value: name, text: `${title} (${words.exerciseKinds[kind] ?? kind})` }))]);
  other.value = "";
  const go = button(words.begin.begin, () => begin(other.value), { "aria-label": `${words.begin.begin}: ${words.begin.other}`, disabled: true });
  return section(
    words.begin.title,
    lines.length > 0 ? el("ul", { class: "begin-cards" }, ...lines.map((line) => card(line, exercises, () => begin(line.exercise)))) : el("p", { class: "hint" }, words.begin.nothing),
    lines.length > 0 ? null : templates,
    el("div", { class: "field begin-other" }, el("span", { class: "quiet-text", "aria-hidden": "true" }, words.begin.other), el("div", { class: "begin-row" }, el("div", {}, other.button, other.list), go)),
    lines.length > 0 ? el("details", {}, el("summary", {}, words.templates.title), templates) : null,
  );
}

/// @param begin  gets the skill of a simulated participant; empty: a person. What it throws is shown
export function confirmPanel(patient: Patient, exercise: Exercise, begin: (demo: string) => Promise<void>, cancel: () => void): HTMLElement {
  const id = newId("confirm");
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const simulated = isSimulated(patient);
  const skills = Object.entries(words.begin.skills).map(([value, text]) => ({ value, text }));
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
    el("p", { class: "run-title", lang: stationLanguage }, exercise.title),
    against.length > 0 ? el("ul", { class: "patient-told" }, ...against.map((text) => el("li", { class: "refused" }, text))) : null,
    doer?.element,
    refused,
    el("div", { class: "buttons" }, yes, button(words.cancel, cancel)),
    el("p", { class: "hint" }, words.begin.resists),
  );
}
