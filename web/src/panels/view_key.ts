// SPDX-License-Identifier: Apache-2.0
// The key of lengths, colours and signs in the 3D view.
import { notFelt } from "../state/channels";
import type { Shown } from "../state/shown";
import { strings } from "../strings";
import { forceStops } from "../view3d/force_colour";
import { forceScale } from "../view3d/force_scale";
import { el, setAttribute, setShown, setText } from "./dom";

const words = strings.view.key;

export function viewKey(shown: Shown): HTMLElement {
  const bar = el("span", { class: "force-bar", role: "img" });
  bar.style.background = `linear-gradient(to right, transparent, ${forceStops.map(({ at, colour }) => `${colour} ${100 * at}%`).join(", ")})`;
  const end = el("span");
  const slips = el("span", { class: "slip-key" }, el("span", { class: "slip-mark", "aria-hidden": "true" }), words.slips);
  const hollow = el("span", { class: "hollow-key" }, el("span", { class: "hollow-mark", "aria-hidden": "true" }), words.notFelt);
  const update = () => {
    const scale = forceScale(shown.digitLimit);
    const newtons = String(scale.end);
    setText(end, Number.isFinite(scale.limit) ? words.limit(newtons) : words.noLimit(newtons));
    setAttribute(bar, "aria-label", words.scale(newtons));
    setAttribute(bar, "title", words.scale(newtons));
    setShown(slips, shown.slides);
  };
  shown.on(["state", "connection"], update);
  shown.on(["state"], () => setShown(hollow, notFelt(shown).includes(true)));
  setShown(hollow, false);
  update();
  return el("div", { class: "view-key" }, el("span", { class: "force-scale" }, "0", bar, end), slips, hollow);
}
