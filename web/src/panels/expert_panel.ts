// SPDX-License-Identifier: Apache-2.0
// Everything beyond a session's few controls: force law, stabiliser, object, grasp, limits, and every key of a scene.
import { kDigitLimit } from "../state/keys";
import { number } from "../state/toml";
import { strings } from "../strings";
import { refusal, change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, section, setShown, setText } from "./dom";
import { graspSection } from "./grasp_section";
import { objectSection } from "./object_section";
import type { OwnObject } from "./own_object";
import { choiceRow, guarded, numberRow, row, shownNumber } from "./setting_controls";
import { settingsList } from "./settings_list";
import { kMethod, stabiliserInForce } from "./smoothing";

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
  let pending = false; // a request is

  async function go(): Promise<void> {
    made.refuse("");
    pending = true;
    update();
    const refused = refusal(await app.host.loadScene(box.value));
    pending = false;
    made.refuse(refused);
    if (refused === "") chosen = "";
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
    load.disabled = chosen === "" || chosen === current || pending;
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
  return section(strings.force.title, choiceRow(app, "force.law", strings.force.law, strings.force.laws));
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
    method,
    numberRow(app, "smoothing.max_n_per_s", words.rise, strings.units.newtonPerSecond),
    fall,
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
  return section(words.title, list);
}

export function expertPanel(app: App, own: Pick<OwnObject, "open">): HTMLElement {
  const chosen = el(
    "div",
    {},
    guarded(app, forceSection(app), calmSection(app), sceneSection(app), objectSection(app, () => own.open()), graspSection(app)),
    limitsSection(app),
  );
  const all = settingsList(app, (searching) => setShown(chosen, !searching));
  return el("div", {}, all.head, chosen, all.element);
}
