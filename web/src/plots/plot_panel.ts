// SPDX-License-Identifier: Apache-2.0
// The plots below the view, and what is shown in them.
import "uplot/dist/uPlot.min.css";
import { button, el, setAttribute, setShown, setSwitch, setText, switchButton } from "../panels/dom";
import { followers } from "../state/channels";
import type { Pausing, Shown } from "../state/shown";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import { lasting } from "../wire/memory";
import { chart, type Chart } from "./chart";
import { saveCsv, savePng, saveSvg } from "./export";
import {
  axisOf,
  firstChoice,
  kindsOf,
  linesOf,
  plotSubjects,
  titleOf,
  type Curve,
  type PlotChoice,
  type PlotKind,
  type PlotSubject,
} from "./plot_kinds";
import { selectionTable } from "./selection_table";
import { TimeView, type Span } from "./time_view";

const kChosen = "phalanx.plots";
const words = strings.plots;

export interface PlotPanel {
  readonly element: HTMLElement;
  draw(): void;
  update(): void; // what follows the clock: whether the curves are of now
  setTheme(theme: ThemeName): void;
  dispose(): void;
}

/// Buttons of which one is chosen.
function segmented<Value>(label: string, choices: readonly (readonly [Value, string])[], pick: (value: Value) => void) {
  const buttons = choices.map(([value, text]) => ({ value, made: button(text, () => pick(value)) }));
  const element = el("div", { class: "segmented", role: "group", "aria-label": label }, ...buttons.map(({ made }) => made));
  const choose = (chosen: Value) => buttons.forEach(({ value, made }) => setAttribute(made, "aria-pressed", String(value === chosen)));
  return { element, choose };
}

/// A line as the curve is drawn.
function lineSample({ colour, width, dash }: Pick<Curve, "colour" | "width" | "dash">): HTMLElement {
  const line = el("span", { class: "plot-line", "aria-hidden": "true" });
  line.style.borderTop = `${Math.round(width)}px ${dash.length > 0 ? "dashed" : "solid"} ${colour}`;
  return line;
}

function firstSubject(): PlotSubject {
  const stored = lasting.get(kChosen);
  return plotSubjects.find((one) => one === stored) ?? firstChoice.subject;
}

/// @param pausing  absent: the curves cannot be held
/// @param onTime  called with the time that is pointed at, on the ticks' clock [s]; null: none
export function plotPanel(source: Shown, theme: ThemeName, pausing?: Pausing, onTime: (time: number | null) => void = () => {}): PlotPanel {
  let colours = theme;
  let choice: PlotChoice = { ...firstChoice, subject: firstSubject(), computed: followers(source.sensedJoint) };
  let measures = false; // a drag selects
  const view = new TimeView(source.history, source.windows[0]!);
  const charts = new Map<PlotKind, Chart>();
  const keys = new Map<PlotKind, HTMLElement>(); // legends of curves without names at their ends
  const area = el("div", { class: "plot-area" });
  const table = selectionTable(source.history, view, () => [...charts].map(([kind, one]) => ({ kind, curves: one.curves() })));

  function showKeys(): void {
    for (const [kind, one] of charts) {
      const key = keys.get(kind)!;
      setShown(key, choice.subject !== "digits" && !one.named());
      key.replaceChildren(...one.curves().filter(({ short }) => short !== "").map((curve) => el("span", {}, lineSample(curve), curve.short)));
    }
  }
  const draw = () => {
    view.refresh();
    for (const one of charts.values()) one.draw();
  };
  function rebuild(): void {
    for (const one of charts.values()) one.dispose();
    charts.clear();
    keys.clear();
    area.replaceChildren();
    const kinds = kindsOf[choice.subject];
    if (kinds.length > 1) tools.append(legend);
    for (const kind of kinds) {
      const title = el("strong", {}, words.axis(titleOf(kind, choice), words.units[kind]));
      const key = el("small", { class: "plot-key", hidden: true });
      const place = el("div", { class: "plot-place" });
      const caption = el("figcaption", {}, title, el("small", {}, linesOf(kind)), key, kinds.length > 1 ? null : legend);
      area.append(el("figure", { class: "plot-box", "aria-label": axisOf(kind) }, caption, place));
      const made = chart(kind, source, view, choice, colours, () => measures);
      place.append(made.element);
      charts.set(kind, made);
      keys.set(kind, key);
    }
    for (const one of charts.values()) one.resize();
    showKeys();
    table.update();
  }

  // ---- the legend: a digit is shown or not, or is the chosen one

  const legend = el("div", { class: "switches plot-legend", role: "group", "aria-label": words.digits });
  function legendEntry(digit: number): HTMLElement {
    const name = strings.digits[digit] ?? "";
    const computed = choice.computed[digit] ?? false;
    const attributes = { "data-digit": digit, "data-computed": computed, title: computed ? strings.followsWhy : undefined };
    if (choice.subject === "digits") {
      const control = switchButton(name, (on) => {
        choice = { ...choice, digits: choice.digits.map((shown, i) => (i === digit ? on : shown)) };
        setSwitch(control, on);
        for (const one of charts.values()) one.setChoice(choice);
        table.update();
      }, attributes);
      setSwitch(control, choice.digits[digit] ?? false);
      return control;
    }
    return button(name, () => {
      choice = { ...choice, digit };
      buildLegend();
      rebuild();
      legend.querySelector<HTMLElement>(`[data-digit="${digit}"]`)?.focus();
    }, { ...attributes, class: "choose", "aria-pressed": String(choice.digit === digit) });
  }
  /// Digits that follow others come last, with the word before them.
  function buildLegend(): void {
    const all = strings.digits.map((_, digit) => digit);
    const computed = all.filter((digit) => choice.computed[digit]);
    legend.replaceChildren(
      ...all.filter((digit) => !choice.computed[digit]).map(legendEntry),
      ...(computed.length > 0 ? [el("small", {}, words.computedDigits)] : []),
      ...computed.map(legendEntry),
    );
  }
  const follow = () => {
    const computed = followers(source.sensedJoint);
    if (computed.join() === choice.computed.join()) return;
    choice = { ...choice, computed };
    buildLegend();
    rebuild();
  };
  source.on(["state"], follow);

  // ---- tools

  const subjectChoices = plotSubjects.map((one) => [one, words.subjects[one]] as const);
  const subjects = segmented(words.which, subjectChoices, (subject) => {
    if (subject === choice.subject) return;
    choice = { ...choice, subject };
    lasting.set(kChosen, subject);
    subjects.choose(subject);
    buildLegend();
    rebuild();
  });
  subjects.choose(choice.subject);
  const windows = segmented(words.window, source.windows.map((seconds) => [seconds, words.windows(seconds)] as const), (seconds) => {
    source.reachBack(seconds);
    view.seconds = seconds;
  });
  const back = button(words.back, () => (view.zoom = undefined), { class: "back", hidden: true });
  const measure = switchButton(words.measure, (on) => {
    measures = on;
    setSwitch(measure, on);
  }, { title: words.measureLong });
  const pause = button(words.pause, () => pausing?.setPaused(!pausing.paused), { "aria-keyshortcuts": "p", class: "pause", hidden: !pausing });
  const paused = el("span", { class: "paused", role: "status" }, words.paused);
  const update = () => {
    setText(pause, pausing?.paused ? words.resume : words.pause);
    setShown(paused, pausing?.paused ?? false);
  };
  source.on(["own"], update);
  update();
  view.on(["span"], () => {
    windows.choose(view.zoom ? NaN : view.seconds);
    setShown(back, view.zoom !== undefined);
    for (const one of charts.values()) one.draw();
  });
  windows.choose(view.seconds);
  view.on(["selection"], () => {
    for (const one of charts.values()) one.draw();
  });
  view.on(["pointed"], () => onTime(view.pointed));
  const save = (text: string, long: string, act: (span: Span) => void) => button(text, () => act(view.span), { title: long, "aria-label": long });

  const unsaved = el("p", { class: "refused", role: "alert", hidden: true }, words.pngFailed);
  async function png(span: Span): Promise<void> {
    setShown(unsaved, false);
    try {
      await savePng(source, choice, span);
    } catch (reason) {
      console.error(reason);
      setShown(unsaved, true);
    }
  }
  const dead = el("p", { class: "plot-offline", role: "status" });
  const live = () => {
    const why = source.oldCurves;
    setText(dead, why === "" ? "" : words.old[why]);
    setShown(dead, why !== "");
    area.classList.toggle("plot-dead", source.lost);
  };
  source.on(["connection", "tick"], live);
  live();
  buildLegend();
  const tools = el(
    "div",
    { class: "plot-tools" },
    subjects.element,
    el("div", { class: "switches" }, back, windows.element),
    el(
      "div",
      { class: "switches" },
      paused,
      pause,
      measure,
      save(words.csv, words.csvLong, (span) => saveCsv(source, span)),
      save(words.svg, words.svgLong, (span) => saveSvg(source, choice, span)),
      save(words.png, words.pngLong, (span) => void png(span)),
      unsaved,
    ),
  );
  const element = el("section", { class: "plots", "aria-label": words.label }, tools, el("div", { class: "plot-frame" }, area, table.element, dead));
  const resizing = new ResizeObserver(() => {
    for (const one of charts.values()) one.resize();
    showKeys();
  });
  resizing.observe(area);
  let disposed = false;
  queueMicrotask(() => disposed || rebuild());
  return {
    element,
    draw,
    update: live,
    setTheme: (next) => {
      colours = next;
      for (const one of charts.values()) one.setTheme(next);
      showKeys();
      table.update();
    },
    dispose: () => {
      disposed = true;
      resizing.disconnect();
      for (const one of charts.values()) one.dispose();
      charts.clear();
    },
  };
}
