// SPDX-License-Identifier: Apache-2.0
// The slider of the stiffness: what a wall of that stiffness resembles, a scale in newtons per millimetre, and where this device shook.
import { SeenShaking } from "../state/seen_shaking";
import { strings } from "../strings";
import type { App } from "./app";
import { el, setShown, setText } from "./dom";
import { logSliderRow, toScale } from "./setting_controls";

const words = strings.force;
const kSetting = "force.stiffness_n_per_mm";
const kSoftest = 0.1; // [N/mm]
const kStiffest = 5;
const kTicks: readonly number[] = [0.1, 0.2, 0.5, 1, 2, 5];
const kMaterials: readonly number[] = [0.2, 0.8, 3.2]; // [N/mm] that the words stand at

/// Places an element on the scale. The slider's ends are half a thumb from its edges.
function at(element: HTMLElement, newtonsPerMillimetre: number): HTMLElement {
  element.style.setProperty("--at", toScale(newtonsPerMillimetre, kSoftest, kStiffest).toFixed(4));
  return element;
}

export function stiffnessRow(app: App): HTMLElement {
  const seen = new SeenShaking();
  const zone = el("span", { class: "scale-shook", hidden: true });
  const scale = el(
    "div",
    { class: "scale", "aria-hidden": "true" },
    zone,
    ...kTicks.map((tick) => at(el("span", { class: "scale-tick" }, String(tick)), tick)),
    ...kMaterials.map((place, i) => at(el("span", { class: "scale-word" }, words.materials[i] ?? ""), place)),
  );
  const said = el("p", { class: "hint" });
  const row = logSliderRow(app, kSetting, { label: words.stiffness, field: words.stiffnessField, unit: strings.units.stiffness }, kSoftest, kStiffest, scale);
  const show = () => {
    const { state } = app.store;
    const least = seen.from(state);
    const shook = Number.isFinite(least);
    setShown(zone, shook);
    if (shook) at(zone, least);
    setText(said, shook ? words.shook(least.toPrecision(2)) : words.notKnown);
    setShown(said, shook || state?.deviceSimulated === false);
  };
  app.store.on(["tick"], () => {
    const { tick, state } = app.store;
    if (tick && seen.feed(tick, state)) show();
  });
  app.store.on(["state", "connection", "own"], show);
  show();
  return el("div", { class: "stiffness" }, row, said);
}
