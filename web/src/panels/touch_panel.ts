// SPDX-License-Identifier: Apache-2.0
// The panel of the contact: scene, object, force, stabiliser, limits.
import { kDigitLimit, keyOf } from "../state/keys";
import { number, quote, unquote } from "../state/toml";
import { strings } from "../strings";
import type { Change } from "../wire/host";
import { refusal, change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, section, setShown, setText } from "./dom";
import { graspSection } from "./grasp_section";
import { objectSection } from "./object_section";
import { choiceRow, guarded, logSliderRow, numberRow, row, shownNumber, switchRow } from "./setting_controls";
import { openSettings } from "./settings_list";

const kSoftest = 0.1; // [N/mm]
const kStiffest = 5;

function sceneSection(app: App): HTMLElement {
  const box = new ChoiceBox(() => {
    chosen = box.value;
    made.refuse("");
    update();
  });
  const made = row(strings.scene.label, box);
  const load = button(strings.scene.load, () => void go(), { class: "primary" });
  const description = el("p", { class: "hint" });
  const changes = el("span", { class: "hint" });
  const back = button(strings.scene.reset, () => void reset());
  let chosen = "";

  async function go(): Promise<void> {
    made.refuse("");
    load.disabled = true;
    made.refuse(refusal(await app.host.loadScene(box.value)));
    chosen = "";
    update();
  }
  async function reset(): Promise<void> {
    const changed = app.store.state?.changed ?? [];
    made.refuse(await change(app, changed.map((one) => [one.key, ""] as const)));
  }
  function update(): void {
    const { welcome, state } = app.store;
    const current = state?.scene ?? "";
    const known = welcome?.scene.map((one) => ({ value: one.name, text: one.name, title: one.meaning })) ?? [];
    const listed = known.some((one) => one.value === current) || current === "";
    box.setChoices(listed ? known : [{ value: current, text: current, title: "" }, ...known]);
    box.value = chosen || current;
    load.disabled = chosen === "" || chosen === current;
    const meaning = chosen ? welcome?.scene.find((one) => one.name === chosen)?.meaning : state?.sceneDescription;
    setText(description, meaning ?? "");
    const count = state?.changed.length ?? 0;
    setText(changes, strings.scene.changes(count));
    setShown(differs, count > 0);
  }
  const differs = el("div", { class: "buttons" }, changes, back);
  app.store.on(["state", "connection"], update);
  update();
  return section(strings.scene.title, made.element, description, el("div", { class: "buttons" }, load), differs);
}

function forceSection(app: App): HTMLElement {
  const words = strings.force;
  return section(
    words.title,
    logSliderRow(
      app,
      "force.stiffness_n_per_mm",
      { label: words.stiffness, field: words.stiffnessField, unit: strings.units.stiffness, low: words.softer, high: words.stiffer },
      kSoftest,
      kStiffest,
    ),
    choiceRow(app, "force.law", words.law, words.laws),
  );
}

const kMethod = "stabiliser.method";

export function stabiliserInForce(app: App): string {
  return unquote(app.store.value(kMethod));
}

/// The methods that the switch turns on and off. Both go over in contact, as "none" does.
const kSmoothing: readonly string[] = ["smoothing", "rise_only"];
/// @returns the method of a scene that states none, as written in a file
const defaultMethod = (app: App) => keyOf(app.store.welcome, kMethod)?.defaultValue ?? "";

/// @returns the method that the switch turns on, as written in a file: the papers' where the scene states a bound on the fall, else the default
function methodTurnedOn(app: App): string {
  const boundsFall = app.store.state?.value.some((one) => one.key.startsWith("smoothing.min_n")) ?? false;
  return boundsFall ? quote("smoothing") : defaultMethod(app);
}

function smoothingSwitch(app: App): HTMLElement {
  const words = strings.calm;
  const isOn = () => kSmoothing.includes(stabiliserInForce(app));
  const changes = (on: boolean): readonly Change[] => [[kMethod, on ? methodTurnedOn(app) : quote("none")]];
  const blocked = () => (isOn() || stabiliserInForce(app) === "none" ? "" : words.smoothingOther);
  return switchRow(app, words.smoothing, words.smoothingHint, isOn, changes, blocked);
}

function calmSection(app: App): HTMLElement {
  const words = strings.calm;
  const method = choiceRow(app, kMethod, words.method, words.methods);
  // Only the papers' method bounds the fall.
  const fall = numberRow(app, "smoothing.min_n_per_s", words.fall, strings.units.newtonPerSecond);
  const showFall = () => setShown(fall, stabiliserInForce(app) === "smoothing");
  app.store.on(["state", "own", "connection"], showFall);
  showFall();
  return section(
    words.title,
    smoothingSwitch(app),
    numberRow(app, "smoothing.max_n_per_s", words.rise, strings.units.newtonPerSecond),
    fall,
    method,
    numberRow(app, "rate_hz", words.rate, strings.units.hertz),
  );
}

function limitsSection(app: App): HTMLElement {
  const words = strings.limits;
  const shown: readonly (readonly [string, string, string])[] = [
    [kDigitLimit, words.force, strings.units.newton],
    ["limits.joint_torque_nm", words.torque, strings.units.torque],
    ["limits.torque_rate_nm_per_s", words.torqueRate, strings.units.torqueRate],
    ["limits.joint_speed_rad_per_s", words.speed, strings.units.radianPerSecond],
  ];
  const list = el("dl", { class: "facts" });
  const update = () => {
    list.replaceChildren(
      ...shown.flatMap(([setting, label, unit]) => {
        const value = app.store.value(setting);
        const off = Number.isNaN(number(value));
        const text = value === "" ? strings.dash : off ? words.off : `${shownNumber(value)} ${unit}`;
        return [el("dt", {}, label), el("dd", { class: off && value !== "" ? "bad" : undefined }, text)];
      }),
    );
  };
  app.store.on(["state", "connection"], update);
  update();
  return section(words.title, list, el("p", { class: "hint" }, words.change));
}

export function touchPanel(app: App): HTMLElement {
  return el(
    "div",
    {},
    guarded(app, forceSection(app), calmSection(app), sceneSection(app), objectSection(app), graspSection(app)),
    limitsSection(app),
    el("div", { class: "buttons" }, button(strings.settings.open, () => openSettings(app))),
  );
}
