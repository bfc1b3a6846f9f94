// SPDX-License-Identifier: Apache-2.0
// The patients of the station: code, side, and the picture that tells one from the other at a glance. Also the exercises that can be prescribed.
import { button, el, section } from "../panels/dom";
import { table } from "./form";
import type { Exercise, Listed, Unreadable } from "./shapes";
import { picture } from "./symbols";
import { titleText, words } from "./words";

export const sideText = ({ side }: Listed): string => words.sides[side] ?? side;
export const symbolText = ({ symbol }: Listed): string => words.symbols[symbol] ?? symbol;

/// What keeps a patient from an exercise on this device, in words; empty: nothing that the station knows.
export const obstacleTexts = ({ obstacles }: Listed): readonly string[] => obstacles.map((one) => words.obstacles[one] ?? one);

function item(patient: Listed, chosen: boolean, open: () => void): HTMLElement {
  const against = obstacleTexts(patient);
  const press = button("", open, { class: "patient-item", "aria-current": chosen ? "true" : undefined, title: against.join(" ") });
  press.append(
    picture(patient.symbol),
    el("span", { class: "patient-code" }, patient.code),
    el("span", { class: "patient-side" }, `${sideText(patient)}, ${symbolText(patient)}`),
    against.length > 0 ? el("span", { class: "patient-mark" }, words.list.notReady) : "",
  );
  return el("li", {}, press);
}

function unreadableBox({ damaged, withoutKey }: Unreadable): HTMLElement | null {
  const keyless = withoutKey > 0 ? el("p", { class: "refused" }, words.list.withoutKey(String(withoutKey))) : null;
  if (damaged.length === 0) return keyless;
  const box = el(
    "details",
    { class: "people-damaged" },
    el("summary", { class: "refused" }, words.list.damaged(String(damaged.length))),
    el("p", { class: "hint" }, words.list.damagedHint),
    el("ul", {}, ...damaged.map((record) => el("li", {}, el("code", {}, record)))),
  );
  return el("div", {}, box, keyless);
}

/// @param chosen  record of the displayed patient
export function patientList(patients: readonly Listed[], unreadable: Unreadable, chosen: string, open: (record: string) => void, add: () => void): HTMLElement {
  const items = patients.map((patient) => item(patient, patient.record === chosen, () => open(patient.record)));
  return el(
    "nav",
    { class: "people-box people-list", "aria-label": words.list.label },
    patients.length === 0 ? el("p", { class: "hint" }, words.list.none) : el("ul", {}, ...items),
    button(words.list.add, add, patients.length === 0 ? { class: "primary" } : {}),
    unreadableBox(unreadable),
  );
}

/// The exercises that can be prescribed.
export function exerciseList(exercises: readonly Exercise[]): HTMLElement {
  const { title, none, columns } = words.exercises;
  const rows = exercises.map((one) => [titleText(one), words.exerciseKinds[one.kind] ?? one.kind, el("code", {}, one.name)]);
  const content = exercises.length === 0 ? el("p", { class: "hint" }, none) : table(title, Object.values(columns), rows);
  return el("div", { class: "people-box" }, section(title, content));
}
