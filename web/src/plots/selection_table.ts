// SPDX-License-Identifier: Apache-2.0
// What the curves do in the selection, as a table that is also spoken.
import { button, el, setShown, setText } from "../panels/dom";
import type { History } from "../state/history";
import { strings } from "../strings";
import { unitOf, type Curve, type PlotKind } from "./plot_kinds";
import { figureText } from "./readings";
import { statisticsOf, type Statistics } from "./statistics";
import { lengthOf, type TimeView } from "./time_view";

const kSpokenAfter = 600; // a selection that changes is not spoken [ms]
const words = strings.plots.selection;

export interface Selectable {
  readonly kind: PlotKind;
  readonly curves: readonly Curve[];
}

export interface SelectionTable {
  readonly element: HTMLElement;
  update(): void;
}

/// @param plots  that are shown
export function selectionTable(history: History, view: TimeView, plots: () => readonly Selectable[]): SelectionTable {
  const head = el("strong");
  const body = el("tbody");
  const columns = [words.first, words.last, words.mean, words.peak, words.deviation];
  const titles = [words.curve, ...columns].map((name) => el("th", { scope: "col" }, name));
  const spoken = el("span", { class: "visually-hidden", role: "status" });
  const tools = el(
    "div",
    { class: "switches" },
    button(words.zoom, () => (view.zoom = view.selection)),
    button(words.close, () => (view.selection = undefined), { "aria-label": words.closeLong, title: words.closeLong }),
  );
  const table = el("table", {}, el("thead", {}, el("tr", {}, ...titles)), body);
  const scroll = el("div", { class: "plot-selected-scroll", tabindex: 0, role: "group", "aria-label": words.label }, table);
  const element = el("section", { class: "plot-selected", "aria-label": words.label, hidden: true }, el("header", {}, head, tools), scroll, spoken);
  let timer: ReturnType<typeof setTimeout> | undefined;

  function row(kind: PlotKind, { label, colour }: Curve, found: Statistics): HTMLElement {
    const swatch = el("span", { class: "swatch" });
    swatch.style.background = colour;
    const values = [found.first, found.last, found.mean, found.peak, found.deviation].map((value) => el("td", {}, figureText(kind, value)));
    return el("tr", {}, el("th", { scope: "row" }, swatch, strings.plots.axis(label, unitOf(kind))), ...values);
  }
  function update(): void {
    clearTimeout(timer);
    const { selection } = view;
    setShown(element, selection !== undefined);
    if (!selection) {
      setText(spoken, "");
      return;
    }
    const of = (kind: PlotKind, curve: Curve) => ({ kind, curve, values: statisticsOf(history, curve, selection) });
    const found = plots().flatMap(({ kind, curves }) => curves.map((curve) => of(kind, curve)));
    const length = lengthOf(selection).toFixed(2);
    setText(head, words.length(length, Math.max(0, ...found.map(({ values }) => values.count))));
    body.replaceChildren(...found.map(({ kind, curve, values }) => row(kind, curve, values)));
    const say = ({ kind, curve, values: { mean, peak, deviation } }: (typeof found)[number]) =>
      words.spoken(curve.label, unitOf(kind), figureText(kind, mean), figureText(kind, peak), figureText(kind, deviation));
    timer = setTimeout(() => setText(spoken, [head.textContent, ...found.map(say)].join(". ")), kSpokenAfter);
  }
  view.on(["selection"], update);
  return { element, update };
}
