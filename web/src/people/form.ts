// SPDX-License-Identifier: Apache-2.0
// Fields of a form, without native selects and tick boxes: those take Space or Esc for themselves, and here both mean Stop.
import { ChoiceBox } from "../panels/choice_box";
import { button, el, newId, setShown, setSwitch, setText, switchButton } from "../panels/dom";
import { chips } from "./chips";
import { refusalText } from "./trouble";
import { words } from "./words";

/// text: one line; area: several; number: in `unit`, empty: none; lines: a list, one on each line; date: YYYY-MM-DD; flag: a switch; secret: a new password;
/// choice: one of `choices` in a list; chips: one of a few that are all in sight.
export type FieldKind = "text" | "area" | "number" | "lines" | "date" | "flag" | "secret" | "choice" | "chips";

export interface FieldPlan {
  readonly name: string; // in the station's JSON
  readonly label: string;
  readonly kind: FieldKind;
  readonly unit?: string;
  readonly hint?: string;
  readonly choices?: readonly { readonly value: string; readonly text: string }[];
  readonly longest?: number; // [characters]
  readonly later?: boolean; // folded away behind the others
}

export interface Field {
  readonly element: HTMLElement;
  value(): unknown; // as the station's JSON has it
}

const kLongest = 200;

/// A number as it was typed; a decimal comma is taken for a point. NaN: it is none.
export function typedNumber(text: string): number | null {
  const trimmed = text.trim().replace(",", ".");
  return trimmed === "" ? null : Number(trimmed);
}

function labelled(plan: FieldPlan, control: HTMLElement, below: HTMLElement | null = null): HTMLElement {
  control.id ||= newId("field");
  return el(
    "div",
    { class: "field", "data-kind": plan.kind },
    el("label", { for: control.id }, plan.label, plan.hint ? " " : null, plan.hint ? el("small", {}, plan.hint) : null),
    el("div", { class: "row-control" }, control, plan.unit ? el("span", { class: "unit" }, plan.unit) : null),
    below,
  );
}

function textField(plan: FieldPlan, value: unknown): Field {
  const number = plan.kind === "number";
  const secret = plan.kind === "secret";
  const input = el("input", {
    type: secret ? "password" : "text", maxlength: plan.longest ?? kLongest, autocomplete: secret ? "new-password" : "off", spellcheck: "false", inputmode: number ? "decimal" : undefined, class: number ? "number" : undefined,
  });
  input.value = typeof value === "string" || typeof value === "number" ? String(value) : "";
  return { element: labelled(plan, input), value: () => (number ? typedNumber(input.value) : secret ? input.value : input.value.trim()) };
}

function areaField(plan: FieldPlan, value: unknown): Field {
  const area = el("textarea", { rows: 3, maxlength: plan.longest ?? 2000, spellcheck: "false" });
  area.value = Array.isArray(value) ? value.map(String).join("\n") : typeof value === "string" ? value : "";
  if (plan.kind === "area") return { element: labelled(plan, area), value: () => area.value.trim() };
  const lines = () => area.value.split("\n").map((line) => line.trim()).filter((line) => line !== "");
  return { element: labelled(plan, area), value: lines };
}

function flagField(plan: FieldPlan, value: unknown): Field {
  let on = value === true;
  const control = switchButton(on ? words.yes : words.no, (now) => {
    on = now;
    setSwitch(control, on);
    setText(control, on ? words.yes : words.no);
  }, { "aria-label": plan.label });
  setSwitch(control, on);
  return { element: labelled(plan, control), value: () => on };
}

function choiceField(plan: FieldPlan, value: unknown): Field {
  const box = new ChoiceBox(() => {});
  box.name(plan.label);
  box.setChoices(plan.choices ?? []);
  box.value = typeof value === "string" && value !== "" ? value : (plan.choices?.[0]?.value ?? "");
  return { element: labelled(plan, box.button, box.list), value: () => box.value };
}

function chipsField(plan: FieldPlan, value: unknown): Field {
  const made = chips(plan.label, plan.choices ?? [], typeof value === "string" ? value : "");
  return { element: made.element, value: () => made.value };
}

export function field(plan: FieldPlan, value: unknown): Field {
  if (plan.kind === "lines" || plan.kind === "area") return areaField(plan, value);
  if (plan.kind === "flag") return flagField(plan, value);
  if (plan.kind === "choice") return choiceField(plan, value);
  if (plan.kind === "chips") return chipsField(plan, value);
  return textField(plan, value);
}

/// @param save    gets the values by name; what it throws is shown beside the button
/// @param cancel  absent: there is nothing to go back to
export function form(
  plans: readonly FieldPlan[],
  values: Readonly<Record<string, unknown>>,
  submit: string,
  save: (values: Readonly<Record<string, unknown>>) => Promise<void>,
  cancel?: () => void,
): HTMLFormElement {
  const fields = plans.map((plan) => ({ plan, made: field(plan, values[plan.name]) }));
  const later = fields.filter(({ plan }) => plan.later);
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const send = el("button", { type: "submit", class: "primary" }, submit);
  const element = el(
    "form",
    { class: "people-form", novalidate: true },
    el("div", { class: "fields" }, ...fields.filter(({ plan }) => !plan.later).map(({ made }) => made.element)),
    later.length > 0 ? el("details", {}, el("summary", {}, words.patient.more), el("div", { class: "fields" }, ...later.map(({ made }) => made.element))) : null,
    refused,
    el("div", { class: "buttons" }, send, cancel ? button(words.cancel, cancel) : null),
  );
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    if (send.disabled) return;
    setShown(refused, false);
    send.disabled = true;
    void Promise.resolve()
      .then(() => save(Object.fromEntries(fields.map(({ plan, made }) => [plan.name, made.value()]))))
      .catch((reason: unknown) => {
        setText(refused, refusalText(reason));
        setShown(refused, true);
      })
      .finally(() => (send.disabled = false));
  });
  return element;
}

/// A table with a heading for each column; on a narrow page each cell names its column.
export function table(label: string, columns: readonly string[], rows: readonly (readonly (Node | string)[])[]): HTMLElement {
  const body = rows.map((cells) => el("tr", {}, ...cells.map((cell, i) => el("td", { "data-column": columns[i] }, cell))));
  return el(
    "div",
    { class: "people-scroll" },
    el("table", { "aria-label": label }, el("thead", {}, el("tr", {}, ...columns.map((text) => el("th", { scope: "col" }, text)))), el("tbody", {}, ...body)),
  );
}
