// SPDX-License-Identifier: Apache-2.0
// The choice of how many views are side by side. The browser remembers it.
import { strings } from "../strings";
import { kMostViews } from "../view3d/panes";
import { lasting } from "../wire/memory";
import { button, el, setAttribute } from "./dom";

const kKey = "phalanx.views";
const words = strings.view;

export interface ViewCountChoice {
  readonly element: HTMLElement;
  readonly count: number;
}

export function viewCountChoice(chosen: (count: number) => void): ViewCountChoice {
  const counts = Array.from({ length: kMostViews }, (_, i) => i + 1);
  let count = counts.find((one) => String(one) === lasting.get(kKey)) ?? 1;
  const choices = counts.map((one) => button(String(one), () => choose(one), { role: "radio", "aria-label": words.viewCount(one) }));
  const mark = () => choices.forEach((control, i) => setAttribute(control, "aria-checked", String(counts[i] === count)));
  function choose(one: number): void {
    count = one;
    lasting.set(kKey, String(one));
    mark();
    chosen(one);
  }
  mark();
  const row = el("div", { class: "view-counts", role: "radiogroup", "aria-label": words.views }, ...choices);
  return {
    element: el("div", { class: "view-choice" }, el("span", { "aria-hidden": "true" }, words.views), row),
    get count() {
      return count;
    },
  };
}
