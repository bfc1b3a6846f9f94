// SPDX-License-Identifier: Apache-2.0
// Every key that a scene may hold, as the station lists them, by group; searched by name and meaning.
import { KeyType, type KeyInfo } from "../gen/phalanx/cockpit_pb";
import { belongsTo, defaultOf, objectKind, settingOf } from "../state/keys";
import { fromTyped, unquote } from "../state/toml";
import { strings } from "../strings";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, newId, section, setShown, setSwitch, setText, switchButton } from "./dom";
import { guarded } from "./setting_controls";
import { settingLabel, valueLabel } from "./plain_words";

const words = strings.settings;

const optionsOf = (key: KeyInfo): readonly string[] => (key.type === KeyType.KEY_FLAG ? ["true", "false"] : key.choice);

interface Entry {
  readonly key: KeyInfo;
  readonly element: HTMLElement;
  readonly update: () => void;
}

/// @returns the allowed values as text; the type if any value is allowed
export function allowedText(key: KeyInfo): string {
  const options = optionsOf(key);
  if (options.length > 0) return words.oneOf(options.map((value) => valueLabel(key.path, value)).join(words.join));
  const range = key.range;
  if (!range) return words.types[key.type] ?? "";
  const parts = [
    range.min > -Infinity ? `${range.minOpen ? ">" : ">="} ${String(range.min)}` : "",
    range.max < Infinity ? `${range.maxOpen ? "<" : "<="} ${String(range.max)}` : "",
    range.minusInfinity ? words.orMinusInfinity : "",
    key.type === KeyType.KEY_NUMBER_OR_OFF ? words.orOff : "",
  ].filter((part) => part !== "");
  return parts.length > 0 ? words.range(parts.join(words.join)) : (words.types[key.type] ?? "");
}

/// @returns allowed values, default and requirement of a change as text
/// @param kind  of the object, on which the default may depend
export function factsText(key: KeyInfo, kind: string): string {
  const fallback = valueLabel(key.path, unquote(defaultOf(key, kind)));
  const facts = [allowedText(key), fallback && words.default(fallback), words.change[key.change] ?? ""];
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
    const empty = key.defaultValue === "" ? [{ value: "", text: words.notStated }] : [];
    const box = new ChoiceBox(touched);
    box.setChoices([...empty, ...optionsOf(key).map((value) => ({ value, text: valueLabel(key.path, value) }))]);
    box.button.id = id;
    box.name(settingLabel(key.path));
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
  let pending = false; // a request is
  const touch = () => {
    touched = true;
    set.disabled = pending;
  };
  const field = valueField(key, id, touch, () => !set.disabled && set.click());
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const set = button(words.apply, () => void send(field.value.trim() === "" ? "" : fromTyped(field.value, key.type)));
  const reset = button(words.reset, () => void send(""), { class: "quiet" });
  const facts = el("p", { class: "hint" });

  async function send(value: string): Promise<void> {
    const sent = field.value;
    pending = true;
    setText(error, "");
    update();
    const refused = await change(app, [[setting, value]]);
    pending = false;
    if (refused === "" && field.value === sent) touched = false; // else what was typed stays
    setText(error, refused);
    setShown(error, refused !== "");
    update();
  }
  function update(): void {
    setText(facts, factsText(key, objectKind(app.store.state, app.store.welcome)));
    if (!touched) field.value = unquote(app.store.value(setting));
    set.disabled = !touched || pending;
    const differs = app.store.changed(setting);
    setShown(reset, differs);
    element.classList.toggle("differs", differs);
  }
  const element = el(
    "li",
    { class: "setting" },
    el("label", { for: id }, el("strong", {}, settingLabel(key.path)), " ", el("span", { class: "meaning" }, key.meaning)),
    el("div", { class: "setting-control" }, field.control, el("span", { class: "unit" }, key.unit), set, reset),
    field.below,
    facts,
    el("code", { class: "setting-key" }, setting),
    error,
  );
  update();
  return { key, element, update };
}

/// "force.law": "force"; "objects[].kind": "objects"; "rate_hz": "general".
export function groupOf(path: string): string {
  const dot = path.indexOf(".");
  return dot < 0 ? "general" : path.slice(0, dot).replace("[]", "");
}

export interface SettingsList {
  readonly head: HTMLElement; // search and filter
  readonly element: HTMLElement; // the list, a part that opens for each group
}

/// @param onSearch  called with true while only settings that match are shown
export function settingsList(app: App, onSearch: (searching: boolean) => void): SettingsList {
  const search = el("input", { type: "search", id: newId("search"), placeholder: words.searchHint, autocomplete: "off" });
  const count = el("span", { class: "hint", role: "status" });
  const none = el("p", { class: "hint" }, words.none);
  const only = switchButton(words.onlyChanged, (on) => {
    setSwitch(only, on);
    filter();
  });
  const group = new ChoiceBox(() => filter());
  group.name(words.group);
  const list = el("div", { class: "settings" });
  let entries: readonly Entry[] = [];
  let groups = new Map<string, { readonly element: HTMLDetailsElement; readonly entries: Entry[] }>();
  let built: readonly KeyInfo[] | undefined;

  function build(): void {
    const keys = app.store.welcome?.key ?? [];
    if (keys === built) return;
    built = keys;
    entries = keys.map((key) => entry(app, key));
    groups = new Map();
    for (const one of entries) {
      const name = groupOf(one.key.path);
      if (!groups.has(name)) groups.set(name, { element: el("details", { class: "settings-group" }, el("summary", {}, words.groups[name] ?? name), el("ul")), entries: [] });
      groups.get(name)!.entries.push(one);
      groups.get(name)!.element.lastElementChild!.append(one.element);
    }
    list.replaceChildren(...[...groups.values()].map((one) => one.element));
    group.setChoices([{ value: "", text: words.allGroups }, ...[...groups.keys()].map((value) => ({ value, text: words.groups[value] ?? value }))]);
    group.value = group.value; // its text
  }
  function filter(): void {
    const wanted = search.value.toLowerCase().split(/\s+/).filter((word) => word !== "");
    const kind = objectKind(app.store.state, app.store.welcome); // in force
    const onlyChanged = only.getAttribute("aria-checked") === "true";
    const searching = wanted.length > 0 || onlyChanged || group.value !== "";
    let shown = 0;
    for (const [name, { element, entries: members }] of groups) {
      let here = 0;
      for (const one of members) {
        const text = `${settingLabel(one.key.path)} ${one.key.path} ${one.key.meaning}`.toLowerCase();
        const fits =
          (group.value === "" || group.value === name) &&
          wanted.every((word) => text.includes(word)) &&
          belongsTo(one.key, kind) &&
          (!onlyChanged || app.store.changed(settingOf(one.key.path)));
        setShown(one.element, fits);
        if (fits) ++here;
      }
      setShown(element, here > 0);
      if (searching) element.open = true;
      shown += here;
    }
    if (!searching && wasSearching) for (const { element } of groups.values()) element.open = false;
    wasSearching = searching;
    setText(count, words.count(shown, entries.length));
    setShown(count, searching);
    setShown(none, shown === 0);
    onSearch(searching);
  }
  let wasSearching = false;
  const update = () => {
    build();
    for (const one of entries) one.update();
    filter();
  };
  app.store.on(["state", "connection", "own"], update);
  search.addEventListener("input", filter);
  update();
  const head = el(
    "div",
    { class: "settings-head", role: "search" },
    el("label", { for: search.id, class: "visually-hidden" }, words.search),
    search,
    group.button,
    only,
    group.list,
    count,
  );
  return { head, element: guarded(app, section(words.title, list, none)) };
}
