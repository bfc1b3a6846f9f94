// SPDX-License-Identifier: Apache-2.0
// The plots below the view, and what is shown in them.
import "uplot/dist/uPlot.min.css";
import { button, el, setShown, setSwitch, setText, switchButton } from "../panels/dom";
import { kDigits } from "../state/channels";
import type { Pausing, Shown } from "../state/shown";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import { lasting } from "../wire/memory";
import { chart, type Chart } from "./chart";
import { saveCsv, savePng } from "./export";
import { legendOf, plotKinds, titleOf, type PlotKind } from "./plot_kinds";

const kKinds = "phalanx.plots";
const kWide = 1400; // [px]: from here on there is room for all of them
const words = strings.plots;

export interface PlotPanel {
  readonly element: HTMLElement;
  draw(): void;
  update(): void; // what follows the clock: whether the curves are of now
  setTheme(theme: ThemeName): void;
  dispose(): void;
}

function firstKinds(): Set<PlotKind> {
  const stored = lasting.get(kKinds).split(",");
  const known = plotKinds.filter((kind) => stored.includes(kind));
  if (known.length > 0) return new Set(known);
  return new Set(window.innerWidth >= kWide ? plotKinds : ["force"]);
}

/// @param pausing  absent: the curves cannot be held
export function plotPanel(source: Shown, theme: ThemeName, pausing?: Pausing): PlotPanel {
  let colours = theme;
  let digits: readonly boolean[] = new Array<boolean>(kDigits).fill(true);
  const kinds = firstKinds();
  const charts = new Map<PlotKind, Chart>();
  const area = el("div", { class: "plot-area" });

  function rebuild(): void {
    for (const one of charts.values()) one.dispose();
    charts.clear();
    area.replaceChildren();
    for (const kind of plotKinds.filter((one) => kinds.has(one))) {
      const box = el("figure", { class: "plot-box" });
      area.append(box);
      box.append(el("figcaption", {}, el("strong", {}, titleOf(kind)), el("small", { title: legendOf(kind) }, legendOf(kind))));
      const place = el("div", { class: "plot-place" });
      box.append(place);
      const made = chart(kind, source.history, colours, digits);
      place.append(made.element);
      charts.set(kind, made);
      made.resize();
    }
  }

  const kindSwitches = plotKinds.map((kind) => {
    const control = switchButton(words.titles[kind], (on) => {
      if (on) kinds.add(kind);
      else kinds.delete(kind);
      lasting.set(kKinds, [...kinds].join(","));
      setSwitch(control, on);
      rebuild();
    });
    setSwitch(control, kinds.has(kind));
    return control;
  });
  const digitSwitches = digits.map((_, digit) => {
    const control = switchButton(strings.digits[digit] ?? "", (on) => {
      digits = digits.map((shown, i) => (i === digit ? on : shown));
      setSwitch(control, on);
      for (const one of charts.values()) one.setDigits(digits);
    }, { "data-digit": digit });
    setSwitch(control, true);
    return control;
  });
  const pause = button(words.pause, () => pausing?.setPaused(!pausing.paused), { "aria-keyshortcuts": "p", class: "pause", hidden: !pausing });
  const paused = el("span", { class: "paused", role: "status" }, words.paused);
  const update = () => {
    setText(pause, pausing?.paused ? words.resume : words.pause);
    setShown(paused, pausing?.paused ?? false);
  };
  source.on(["own"], update);
  update();
  const png = button(words.png, () =>
    savePng(source, [...charts].map(([kind, one]) => ({ title: titleOf(kind), legend: legendOf(kind), canvas: one.canvas() })), digits, colours),
    { title: words.pngLong, "aria-label": words.pngLong },
  );
  const dead = el("p", { class: "plot-offline", role: "status" });
  const live = () => {
    const why = source.oldCurves;
    setText(dead, why === "" ? "" : words.old[why]);
    setShown(dead, why !== "");
    area.classList.toggle("plot-dead", source.lost);
  };
  source.on(["connection", "tick"], live);
  live();
  const tools = el(
    "div",
    { class: "plot-tools" },
    el("div", { class: "switches", role: "group", "aria-label": words.which }, ...kindSwitches),
    el("div", { class: "switches", role: "group", "aria-label": words.digits }, ...digitSwitches),
    el("div", { class: "switches" }, paused, pause, button(words.csv, () => saveCsv(source), { title: words.csvLong, "aria-label": words.csvLong }), png),
  );
  const element = el("section", { class: "plots", "aria-label": words.label }, tools, el("div", { class: "plot-frame" }, area, dead));
  const resizing = new ResizeObserver(() => {
    for (const one of charts.values()) one.resize();
  });
  resizing.observe(area);
  let disposed = false;
  queueMicrotask(() => disposed || rebuild());
  return {
    element,
    draw: () => {
      for (const one of charts.values()) one.draw();
    },
    update: live,
    setTheme: (next) => {
      colours = next;
      for (const one of charts.values()) one.setTheme(next);
    },
    dispose: () => {
      disposed = true;
      resizing.disconnect();
      for (const one of charts.values()) one.dispose();
      charts.clear();
    },
  };
}
