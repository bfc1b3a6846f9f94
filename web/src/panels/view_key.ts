// SPDX-License-Identifier: Apache-2.0
// The key of lengths and colours in the 3D view.
import { strings } from "../strings";
import { arrowLargestForce, arrowMetresPerNewton } from "../view3d/arrow_scale";
import { forceStops } from "../view3d/force_colour";
import { el } from "./dom";

const words = strings.view.key;

export function viewKey(): HTMLElement {
  const last = forceStops.at(-1)!.newtons;
  const bar = el("span", { class: "force-bar", role: "img", "aria-label": words.colours(String(last)) });
  const stops = forceStops.map(({ newtons, colour }) => `${colour} ${(100 * newtons) / last}%`);
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  return el(
    "div",
    { class: "view-key" },
    el("span", {}, words.arrows(String(1000 * arrowMetresPerNewton), String(arrowLargestForce))),
    el("span", { class: "force-scale" }, "0", bar, `${last} ${strings.units.newton}`),
  );
}
