// SPDX-License-Identifier: Apache-2.0
// The key of lengths and colours in the 3D view.
import type { Shown } from "../state/shown";
import { strings } from "../strings";
import { arrowLargestForce, arrowMetresPerNewton } from "../view3d/arrow_scale";
import { forceStops } from "../view3d/force_colour";
import { el, setShown } from "./dom";

const words = strings.view.key;

export function viewKey(shown: Shown): HTMLElement {
  const last = forceStops.at(-1)!.newtons;
  const bar = el("span", { class: "force-bar", role: "img", "aria-label": words.colours(String(last)) });
  const stops = forceStops.map(({ newtons, colour }) => `${colour} ${(100 * newtons) / last}%`);
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const slips = el("span", { class: "slip-key" }, el("span", { class: "slip-mark", "aria-hidden": "true" }), words.slips);
  const update = () => setShown(slips, shown.slides);
  shown.on(["state", "connection"], update);
  update();
  return el(
    "div",
    { class: "view-key" },
    el("span", {}, words.arrows(String(1000 * arrowMetresPerNewton), String(arrowLargestForce))),
    slips,
    el("span", { class: "force-scale" }, "0", bar, `${last} ${strings.units.newton}`),
  );
}
