// SPDX-License-Identifier: Apache-2.0
// What a session needs: the scene, the stiffness, smoothing, and the hand.
import type { App } from "./app";
import { el, section } from "./dom";
import { strings } from "../strings";
import { handSection } from "./hand_section";
import type { OwnObject } from "./own_object";
import { sceneCards } from "./scene_cards";
import { guarded } from "./setting_controls";
import { smoothingSwitch } from "./smoothing";
import { stiffnessRow } from "./stiffness_row";

export function touchPanel(app: App, own: Pick<OwnObject, "open">): HTMLElement {
  const force = section(strings.force.title, stiffnessRow(app), smoothingSwitch(app));
  force.firstElementChild!.classList.add("visually-hidden"); // the stiffness is the heading
  return el("div", {}, guarded(app, sceneCards(app, () => own.open()), force, handSection(app)));
}
