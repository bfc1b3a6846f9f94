// SPDX-License-Identifier: Apache-2.0
// Controls for single keys. Each shows the station's value, requests a change, and shows the reason of a refusal beside it.
import { KeyType } from "../gen/phalanx/cockpit_pb";
import { keyOf, within } from "../state/keys";
import { Throttle } from "../state/throttle";
import { fromNumber, fromTyped, number, quote, unquote } from "../state/toml";
import type { Change } from "../wire/host";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { el, newId, setShown, setSwitch, setText, switchButton } from "./dom";
import { onLetGo } from "./drag";

const kSliderPerSecond = 10;
const kSliderSteps = 1000;

/// A label, a control, its unit, and the reason of a refusal.
export interface Row {
  readonly element: HTMLElement;
  readonly refuse: (text: string) => void; // empty: nothing is wrong
}

export function row(label: string, of: HTMLElement | ChoiceBox, unit = "", hint = ""): Row {
  const control = of instanceof ChoiceBox ? of.button : of;
  if (of instanceof ChoiceBox) of.name(label);
  control.id ||= newId("control");
  const error = el("p", { class: "refused", role: "alert", id: `${control.id}-error`, hidden: true });
  control.setAttribute("aria-describedby", error.id);
  const element = el(
    "div",
    { class: "row" },
    el("label", { for: control.id }, label, hint ? " " : null, hint ? el("small", {}, hint) : null),
    el("div", { class: "row-control" }, control, unit ? el("span", { class: "unit" }, unit) : null),
    error,
    of instanceof ChoiceBox ? of.list : null,
  );
  const refuse = (text: string) => {
    setText(error, text);
    setShown(error, text !== "");
  };
  return { element, refuse };
}

/// Puts a value into a field unless the user is typing there.
function put(field: HTMLInputElement, text: string): void {
  if (document.activeElement === field && field.dataset["touched"] === "yes") return;
  if (field.value !== text) field.value = text;
}

/// Calls `commit` when the user has finished a field; until then `put` does not change it.
function typing(field: HTMLInputElement, commit: () => void): void {
  field.addEventListener("input", () => (field.dataset["touched"] = "yes"));
  field.addEventListener("change", () => {
    delete field.dataset["touched"];
    commit();
  });
  field.addEventListener("blur", () => delete field.dataset["touched"]);
}

/// Formats a number for display.
export function shownNumber(value: string): string {
  const parsed = number(value);
  return Number.isFinite(parsed) ? fromNumber(parsed) : unquote(value);
}

/// Makes a number field for one key.
export function numberRow(app: App, setting: string, label: string, unit: string): HTMLElement {
  const field = el("input", { type: "text", inputmode: "decimal", class: "number", autocomplete: "off" });
  const made = row(label, field, unit);
  const show = () => put(field, shownNumber(app.store.value(setting)));
  typing(field, () => {
    made.refuse("");
    void change(app, [[setting, fromTyped(field.value, KeyType.KEY_NUMBER_OR_OFF)]]).then((refused) => {
      made.refuse(refused);
      show();
    });
  });
  app.store.on(["state", "own", "connection"], show);
  show();
  return made.element;
}

/// Makes a choice for one key.
export function choiceRow(
  app: App,
  setting: string,
  label: string,
  texts: Readonly<Record<string, string>>,
  changes: (choice: string) => readonly Change[] = (choice) => [[setting, quote(choice)]],
  current: () => string = () => unquote(app.store.value(setting)),
): HTMLElement {
  const box = new ChoiceBox(() => {
    made.refuse("");
    if (box.value === current()) return;
    void change(app, changes(box.value)).then((refused) => {
      made.refuse(refused);
      show();
    });
  });
  const made = row(label, box);
  const show = () => {
    const choices = keyOf(app.store.welcome, setting)?.choice ?? [];
    box.setChoices(choices.map((value) => ({ value, text: texts[value] ?? value })));
    box.value = current();
  };
  app.store.on(["state", "own", "connection"], show);
  show();
  return made.element;
}

/// Makes a switch that sets several keys at once.
/// @param blocked  the reason why it cannot be used now; empty: it can
export function switchRow(
  app: App,
  label: string,
  hint: string,
  current: () => boolean,
  changes: (on: boolean) => readonly Change[],
  blocked: () => string = () => "",
): HTMLElement {
  const control = switchButton(label, (on) => {
    made.refuse("");
    void change(app, changes(on)).then((refused) => {
      made.refuse(refused);
      show();
    });
    show();
  });
  control.setAttribute("aria-label", label); // the row's label is the hint
  const made = row(hint, control);
  made.element.classList.add("row-switch");
  const said = made.element.querySelector("label");
  const show = () => {
    const why = blocked();
    setSwitch(control, current());
    control.disabled = why !== "";
    if (said) setText(said, why || hint);
  };
  app.store.on(["state", "own", "connection"], show);
  show();
  return made.element;
}

/// Convert a value to its place on a logarithmic scale, 0 .. 1, and back.
export const toScale = (value: number, min: number, max: number) =>
  Math.min(1, Math.max(0, Math.log(value / min) / Math.log(max / min)));
export const fromScale = (place: number, min: number, max: number) => min * (max / min) ** place;

/// Makes a logarithmic slider with a number field. It sends while it is dragged, and always sends the last value.
/// @param scale  below the slider
export function logSliderRow(
  app: App,
  setting: string,
  texts: { readonly label: string; readonly field: string; readonly unit: string },
  min: number,
  max: number,
  scale: HTMLElement,
): HTMLElement {
  const slider = el("input", { type: "range", min: 0, max: kSliderSteps, step: 1 });
  const field = el("input", { type: "text", inputmode: "decimal", class: "number", "aria-label": texts.field, autocomplete: "off" });
  const made = row(texts.label, slider);
  made.element.classList.add("row-slider");
  made.element.querySelector("label")?.after(el("div", { class: "number-unit" }, field, el("span", { class: "unit" }, texts.unit)));
  made.element.querySelector(".row-control")?.append(scale);
  let dragged = false;
  const rounded = (value: number) => fromNumber(Number(value.toPrecision(2)));

  const tell = () => slider.setAttribute("aria-valuetext", `${field.value} ${texts.unit}`);
  const show = () => {
    if (dragged || throttle.waits) return; // the user's newest value is newer than the station's
    const value = number(app.store.value(setting));
    if (Number.isFinite(value)) slider.value = String(Math.round(kSliderSteps * toScale(Math.max(value, min / 10), min, max)));
    put(field, Number.isFinite(value) ? fromNumber(value) : "");
    tell();
  };
  const send = (value: string, dragging: boolean) => {
    made.refuse("");
    void change(app, [[setting, value]], dragging).then((refused) => {
      made.refuse(refused);
      show();
    });
  };
  const throttle = new Throttle((value: string) => send(value, dragged), kSliderPerSecond);
  slider.addEventListener("input", () => {
    dragged = true;
    const value = rounded(fromScale(Number(slider.value) / kSliderSteps, min, max));
    field.value = value;
    tell();
    throttle.push(value);
  });
  onLetGo(slider, () => {
    if (!dragged) return;
    dragged = false;
    throttle.push(field.value); // also if it has been sent already: now it is the last one
    throttle.flush();
    show();
  });
  typing(field, () => {
    const range = keyOf(app.store.welcome, setting)?.range;
    const typed = fromTyped(field.value, KeyType.KEY_NUMBER);
    if (range && within(number(typed), range)) throttle.push(fromNumber(number(typed)));
    else throttle.push(typed);
  });
  app.store.on(["state", "connection"], () => {
    if (app.store.role === "mine") return;
    throttle.clear(); // this page may not change it any more
    dragged = false;
  });
  app.store.on(["state", "own", "connection"], show);
  show();
  return made.element;
}

/// Makes a fieldset that can be used only while this page has control.
export function guarded(app: App, ...children: readonly (Node | null)[]): HTMLFieldSetElement {
  const fieldset = el("fieldset", { class: "guarded" }, ...children);
  const update = () => {
    const disabled = app.store.role !== "mine";
    if (fieldset.disabled !== disabled) fieldset.disabled = disabled;
  };
  app.store.on(["state", "connection"], update);
  update();
  return fieldset;
}
