// SPDX-License-Identifier: Apache-2.0
// A choice of one among a few that are all in sight: one tap chooses. Buttons, since Space means Stop on this page.
import { button, el, newId, setAttribute } from "../panels/dom";

export interface Chips {
  readonly element: HTMLElement;
  readonly value: string;
}

const kSteps: Readonly<Record<string, number>> = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };

/// @param value  chosen at first; without a choice of this value, none is chosen
export function chips(title: string, choices: readonly { readonly value: string; readonly text: string }[], value: string): Chips {
  const id = newId("chips");
  const radios = choices.map((one) => ({ value: one.value, control: button(one.text, () => choose(one.value), { role: "radio", "data-value": one.value }) }));
  const mark = () => {
    const at = Math.max(0, radios.findIndex((one) => one.value === value)); // Tab goes to the chosen one, or to the first
    radios.forEach((one, i) => {
      setAttribute(one.control, "aria-checked", String(one.value === value));
      setAttribute(one.control, "tabindex", i === at ? "0" : "-1");
    });
  };
  function choose(next: string): void {
    value = next;
    mark();
  }
  mark();
  const group = el("div", { class: "chips", role: "radiogroup", "aria-labelledby": id }, ...radios.map(({ control }) => control));
  group.addEventListener("keydown", (event) => {
    const step = kSteps[event.key];
    if (step === undefined || radios.length === 0) return;
    const at = radios.findIndex(({ control }) => control === document.activeElement);
    const next = radios[(at + step + radios.length) % radios.length]!;
    choose(next.value);
    next.control.focus();
    event.preventDefault();
  });
  return {
    element: el("div", { class: "field", "data-kind": "chips" }, el("span", { class: "field-label", id }, title), group),
    get value() {
      return value;
    },
  };
}
