// SPDX-License-Identifier: Apache-2.0
// The grasp: a type that the station plans for the hand and the object, whatever they are.
import { find, keyOf } from "../state/keys";
import { number, quote, same, table, unquote } from "../state/toml";
import { strings } from "../strings";
import type { Change } from "../wire/host";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, section, setShown, setText } from "./dom";
import { row } from "./setting_controls";

const words = strings.grasp;
const kNone = "none";
const kOwn = ""; // the scene's own wrist and motion, or its own planned grasp
const kKept = ["forearm", "palm", "other_types"]; // by another seed

/// The grasp that was refused for the object in force: it is asked for with the next object of the same scene.
const wantedNext = new WeakMap<App, { readonly scene: string; readonly changes: readonly Change[] }>();
const sceneOf = (app: App): string => app.store.state?.scene ?? "";
export function graspOfNextObject(app: App): readonly Change[] {
  const wanted = wantedNext.get(app);
  return wanted?.scene === sceneOf(app) ? wanted.changes : [];
}

/// @returns the changes that have a grasp planned. The tables are replaced as a whole: the scene's own wrist and motion, and the directions
/// that it states for another type, do not fit.
/// @param others  further keys of the table grasp, and their values
export function plannedGrasp(type: string, seed: number, others: readonly (readonly [string, string])[] = []): readonly Change[] {
  return [
    ["grasp", table([["type", quote(type)], ["seed", String(seed)], ...others])],
    ["motion", table([["name", quote("posture")], ["closure", "1.0"]])],
  ];
}

export function graspSection(app: App): HTMLElement {
  const choice = new ChoiceBox(() => void choose());
  const made = row(words.type, choice);
  const status = el("p", { class: "hint", role: "status" });
  const another = button(words.another, () => void next());
  let planning = false;

  const inForce = () => unquote(app.store.value("grasp.type")) || kNone;
  const chosenHere = () => app.store.state?.changed.some((one) => one.key === "grasp" || one.key.startsWith("grasp.")) ?? false;
  const shown = () => (chosenHere() && inForce() !== kNone ? inForce() : kOwn);

  async function plan(changes: readonly Change[]): Promise<void> {
    made.refuse("");
    planning = true;
    update();
    wantedNext.delete(app);
    try {
      const refused = await change(app, changes);
      if (refused !== "" && changes.some(([, value]) => value !== "")) wantedNext.set(app, { scene: sceneOf(app), changes });
      made.refuse(refused);
    } finally {
      planning = false;
      update();
    }
  }

  async function choose(): Promise<void> {
    if (choice.value === shown()) return;
    await plan(choice.value === kOwn ? [["grasp", ""], ["motion", ""]] : plannedGrasp(choice.value, 1));
  }

  /// The same type with the next seed, from the same sides, with other types where the scene allows them.
  async function next(): Promise<void> {
    const seed = number(app.store.value("grasp.seed"));
    const stated = kKept
      .map((name) => [name, app.store.state?.value.find((one) => one.key === `grasp.${name}`)?.value ?? ""] as const)
      .filter(([, value]) => value !== "");
    await plan(plannedGrasp(inForce(), Number.isFinite(seed) ? seed + 1 : 1, stated));
  }

  function update(): void {
    const types = (keyOf(app.store.welcome, "grasp.type")?.choice ?? []).filter((value) => value !== kNone);
    choice.setChoices([{ value: kOwn, text: words.own }, ...types.map((value) => ({ value, text: words.types[value] ?? value }))]);
    if (!planning) choice.value = shown();
    const wanted = graspOfNextObject(app);
    const asked = wanted.find(([key]) => key === "grasp")?.[1];
    const isInForce = asked !== undefined && same(find(app.store.state?.changed, "grasp") ?? "", asked);
    if (isInForce) {
      wantedNext.delete(app); // since the new object
      made.refuse("");
    }
    setText(status, planning ? words.planning : wanted.length > 0 && !isInForce ? words.next : words.hint);
    choice.button.disabled = planning;
    setShown(another, inForce() !== kNone);
    another.disabled = planning;
  }
  app.store.on(["state", "connection"], update);
  update();
  return section(words.title, made.element, status, el("div", { class: "buttons" }, another));
}
