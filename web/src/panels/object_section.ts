// SPDX-License-Identifier: Apache-2.0
// The object in the hand: a shape with its sizes, or a mesh of one's own.
import { KeyType, type KeyInfo } from "../gen/phalanx/cockpit_pb";
import { belongsTo, defaultOf, keyOf, objectKind } from "../state/keys";
import { fromTyped, quote, unquote } from "../state/toml";
import { strings } from "../strings";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, section, setShown, setText } from "./dom";
import { graspOfNextObject } from "./grasp_section";
import { replaceObject } from "./object_change";
import { row, shownNumber } from "./setting_controls";

const words = strings.object;
const kNotHere = new Set(["kind", "file", "unit", "decimate_to", "position_mm", "rotation_deg"]);

const nameOf = (key: KeyInfo) => key.path.replace("objects[].", "");

function objectKeys(app: App): KeyInfo[] {
  return app.store.welcome?.key.filter((key) => key.path.startsWith("objects[].")) ?? [];
}

/// The sizes that a shape has.
export function sizesOf(app: App, kind: string): KeyInfo[] {
  return objectKeys(app).filter((key) => !kNotHere.has(nameOf(key)) && belongsTo(key, kind));
}

/// @param own  opens the dialog of an object of the user's own
export function objectSection(app: App, own: () => void): HTMLElement {
  const kind = new ChoiceBox(() => choose());
  const kindRow = row(words.kind, kind);
  const sizes = el("div", { class: "sizes" });
  const file = el("p", { class: "hint" });
  const use = button(words.use, () => void apply(), { class: "primary" });
  let chosen = ""; // by the person and not yet used; empty: what is in force
  let built = "";
  let pending = false; // a request is

  const current = () => objectKind(app.store.state, app.store.welcome);
  const fields = new Map<string, HTMLInputElement>();

  function build(): void {
    const shown = chosen || current();
    const keys = shown === "file" ? [] : sizesOf(app, shown);
    const wanted = `${shown} ${keys.map((key) => key.path).join(" ")}`;
    if (wanted === built) return;
    built = wanted;
    fields.clear();
    sizes.replaceChildren(
      ...keys.map((key) => {
        const field = el("input", { type: "text", inputmode: "decimal", class: key.type === KeyType.KEY_VECTOR ? "vector" : "number", autocomplete: "off" });
        fields.set(nameOf(key), field);
        field.addEventListener("input", () => {
          field.dataset["touched"] = "yes";
          chosen ||= current();
          update();
        });
        return row(words.sizes[nameOf(key)] ?? nameOf(key), field, key.unit).element;
      }),
    );
  }

  function truth(name: string): string {
    const shown = chosen || current();
    if (shown === current()) return app.store.value(`objects.0.${name}`);
    const key = objectKeys(app).find((one) => nameOf(one) === name);
    return key ? defaultOf(key, shown) : "";
  }

  function update(): void {
    const kinds = keyOf(app.store.welcome, "objects.0.kind")?.choice ?? [];
    kind.setChoices(kinds.map((value) => ({ value, text: words.kinds[value] ?? value })));
    const shown = chosen || current();
    kind.value = shown;
    build();
    for (const [name, field] of fields) {
      if (field.dataset["touched"] !== "yes") field.value = shownNumber(truth(name));
    }
    setShown(file, current() === "file" && shown === "file");
    setText(file, unquote(app.store.value("objects.0.file")).split("/").pop() ?? "");
    setShown(use, shown !== "file");
    use.disabled = chosen === "" || pending;
  }

  async function apply(): Promise<void> {
    const wanted = kind.value;
    const keys = sizesOf(app, wanted);
    const entries: [string, string][] = [["kind", quote(wanted)]];
    for (const key of keys) {
      const text = fields.get(nameOf(key))?.value ?? "";
      if (text.trim() !== "") entries.push([nameOf(key), fromTyped(text, key.type)]);
    }
    kindRow.refuse("");
    pending = true;
    update();
    const refused = await change(app, [...replaceObject(app.store.state, entries), ...graspOfNextObject(app)]);
    pending = false;
    kindRow.refuse(refused);
    if (refused === "") chosen = built = ""; // else what was typed stays
    update();
  }

  function choose(): void {
    chosen = kind.value === current() ? "" : kind.value;
    if (kind.value === "file") {
      chosen = "";
      own();
    }
    built = "";
    kindRow.refuse("");
    update();
  }
  app.store.on(["state", "connection"], update);
  update();
  return section(words.title, kindRow.element, sizes, file, el("div", { class: "buttons" }, use));
}
