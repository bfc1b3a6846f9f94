// SPDX-License-Identifier: Apache-2.0
// A choice of one among a few that are all in sight, which the browser remembers. Buttons, since Space means Stop on this page: a press or
// Enter chooses, and the arrow keys go from one to the next. Tab goes to the chosen one.
import { lasting } from "../wire/memory";
import { button, el, setAttribute } from "./dom";

export interface RadioOption<Value> {
  readonly value: Value;
  readonly name: string; // for those who cannot see it
  readonly text?: string; // on the button
  readonly colour?: string; // of the button
}

export interface RadioGroup<Value> {
  readonly element: HTMLElement;
  readonly value: Value;
}

const kSteps: Readonly<Record<string, number>> = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };

/// @param key  in the browser's memory  @param look  class of the group  @param usual  chosen until a person chooses
export function radioGroup<Value extends string | number>(
  key: string,
  title: string,
  look: string,
  options: readonly RadioOption<Value>[],
  usual: Value,
  picked: (value: Value) => void,
): RadioGroup<Value> {
  const stored = lasting.get(key);
  let value = options.find((one) => String(one.value) === stored)?.value ?? usual;
  const radios = options.map((option) => {
    const control = button(option.text ?? "", () => choose(option.value), { role: "radio", "aria-label": option.name, title: option.text ? undefined : option.name });
    if (option.colour) control.style.background = option.colour;
    return { value: option.value, control };
  });
  const mark = () => {
    for (const { value: one, control } of radios) {
      setAttribute(control, "aria-checked", String(one === value));
      setAttribute(control, "tabindex", one === value ? "0" : "-1");
    }
  };
  function choose(next: Value): void {
    value = next;
    lasting.set(key, String(next));
    mark();
    picked(next);
  }
  mark();
  const group = el("div", { class: look, role: "radiogroup", "aria-label": title }, ...radios.map(({ control }) => control));
  group.addEventListener("keydown", (event) => {
    const step = kSteps[event.key];
    if (step === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    const at = radios.findIndex((one) => one.value === value);
    const next = radios[(at + step + radios.length) % radios.length]!;
    choose(next.value);
    next.control.focus();
    event.preventDefault();
  });
  return {
    element: el("div", { class: "view-choice" }, el("span", { "aria-hidden": "true" }, title), group),
    get value() {
      return value;
    },
  };
}
