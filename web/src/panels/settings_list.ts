// SPDX-License-Identifier: Apache-2.0
// Every key that a scene may hold, as the station lists them.
import { KeyType, type KeyInfo } from "../gen/phalanx/cockpit_pb";
import { belongsTo, defaultOf, objectKind, settingOf } from "../state/keys";
import { fromTyped, unquote } from "../state/toml";
import { strings } from "../strings";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, newId, setShown, setSwitch, setText, switchButton } from "./dom";
import { openDialog } from "./dialog";

const words = strings.settings;

interface Entry {
  readonly key: KeyInfo;
  readonly element: HTMLElement;
  readonly update: () => void;
}

/// @returns the allowed values as text; the type if any value is allowed
export function allowedText(key: KeyInfo): string {
  if (key.type === KeyType.KEY_FLAG) return `${words.range} true, false`;
  if (key.type === KeyType.KEY_CHOICE) return `${words.range} ${key.choice.join(", ")}`;
  const range = key.range;
  if (!range) return words.types[key.type] ?? "";
  const parts = [
    range.min > -Infinity ? `${range.minOpen ? ">" : ">="} ${String(range.min)}` : "",
    range.max < Infinity ? `${range.maxOpen ? "<" : "<="} ${String(range.max)}` : "",
    range.minusInfinity ? words.orMinusInfinity : "",
    key.type === KeyType.KEY_NUMBER_OR_OFF ? words.orOff : "",
  ].filter((part) => part !== "");
  return parts.length > 0 ? `${words.range} ${parts.join(", ")}` : (words.types[key.type] ?? "");
}

/// @returns allowed values, default and requirement of a change as text
/// @param kind  of the object, on which the default may depend
export function factsText(key: KeyInfo, kind: string): string {
  const fallback = unquote(defaultOf(key, kind));
  const facts = [allowedText(key), fallback && `${words.default} ${fallback}`, words.change[key.change] ?? ""];
  return facts.filter((text) => text !== "").join(" · ");
}

/// Where the value stands, and what a person does there.
interface ValueField {
  value: string;
  readonly control: HTMLElement;
  readonly below: HTMLElement | null;
}

function valueField(key: KeyInfo, id: string, touched: () => void, done: () => void): ValueField {
  if (key.type === KeyType.KEY_FLAG || key.type === KeyType.KEY_CHOICE) {
    const options = key.type === KeyType.KEY_FLAG ? ["true", "false"] : key.choice;
    const text = (value: string) => (value === "true" ? words.on : value === "false" ? words.off : value);
    const empty = key.defaultValue === "" ? [{ value: "", text: words.notStated }] : [];
    const box = new ChoiceBox(touched);
    box.setChoices([...empty, ...options.map((value) => ({ value, text: text(value) }))]);
    box.button.id = id;
    box.name(settingOf(key.path));
    return {
      control: box.button,
      below: box.list,
      get value() {
        return box.value;
      },
      set value(value: string) {
        box.value = value;
      },
    };
  }
  const input = el("input", { id, type: "text", autocomplete: "off", spellcheck: "false", placeholder: words.notStated });
  input.addEventListener("input", touched);
  input.addEventListener("keydown", (event) => event.key === "Enter" && done());
  return {
    control: input,
    below: null,
    get value() {
      return input.value;
    },
    set value(value: string) {
      if (input.value === value) return;
      input.value = value;
      input.title = value; // all of it, where the field is too narrow
    },
  };
}

function entry(app: App, key: KeyInfo): Entry {
  const setting = settingOf(key.path);
  const id = newId("key");
  let touched = false;
  const touch = () => {
    touched = true;
    set.disabled = false;
  };
  const field = valueField(key, id, touch, () => !set.disabled && set.click());
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const set = button(words.apply, () => void send(field.value.trim() === "" ? "" : fromTyped(field.value, key.type)));
  const reset = button(words.reset, () => void send(""), { class: "quiet" });
  const facts = el("p", { class: "hint" });

  async function send(value: string): Promise<void> {
    touched = false;
    setText(error, "");
    set.disabled = true;
    const refused = await change(app, [[setting, value]]);
    setText(error, refused);
    setShown(error, refused !== "");
    update();
  }
  function update(): void {
    setText(facts, factsText(key, objectKind(app.store.state, app.store.welcome)));
    if (!touched) field.value = unquote(app.store.value(setting));
    set.disabled = !touched;
    const differs = app.store.changed(setting);
    setShown(reset, differs);
    element.classList.toggle("differs", differs);
  }
  const element = el(
    "li",
    { class: "setting" },
    el("label", { for: id }, el("code", {}, setting), el("span", { class: "meaning" }, key.meaning)),
    el("div", { class: "setting-control" }, field.control, el("span", { class: "unit" }, key.unit), set, reset),
    field.below,
    facts,
    error,
  );
  update();
  return { key, element, update };
}

let follow: () => void = () => {};
let listening = false;

export function openSettings(app: App): void {
  const search = el("input", { type: "search", id: newId("search"), placeholder: words.searchHint, autocomplete: "off" });
  const count = el("span", { class: "hint", role: "status" });
  const only = switchButton(words.onlyChanged, (on) => {
    setSwitch(only, on);
    filter();
  });
  const none = el("p", { class: "hint" }, words.none);
  const entries = (app.store.welcome?.key ?? []).map((key) => entry(app, key));
  const list = el("ul", { class: "settings" }, ...entries.map((one) => one.element));
  const fieldset = el("fieldset", { class: "guarded" }, list);

  function filter(): void {
    const wanted = search.value.toLowerCase().split(/\s+/).filter((word) => word !== "");
    const kind = objectKind(app.store.state, app.store.welcome); // in force
    const onlyChanged = only.getAttribute("aria-checked") === "true";
    let shown = 0;
    for (const one of entries) {
      const text = `${one.key.path} ${one.key.meaning}`.toLowerCase();
      const fits =
        wanted.every((word) => text.includes(word)) &&
        belongsTo(one.key, kind) &&
        (!onlyChanged || app.store.changed(settingOf(one.key.path)));
      setShown(one.element, fits);
      if (fits) ++shown;
    }
    setText(count, words.count(shown, entries.length));
    setShown(none, shown === 0);
  }
  follow = () => {
    fieldset.disabled = app.store.role !== "mine";
    for (const one of entries) one.update();
    filter();
  };
  if (!listening) app.store.on(["state", "connection", "own"], () => follow());
  listening = true;
  search.addEventListener("input", filter);
  follow();
  const head = el("div", { class: "settings-head" }, el("label", { for: search.id }, words.search), search, only, count);
  openDialog(app, words.title, [head, fieldset, none], "large", () => (follow = () => {}));
  search.focus();
}
