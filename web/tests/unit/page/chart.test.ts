// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeAll, beforeEach, describe, expect, it, vi } from "vitest";
import { chart, type Chart } from "../../../src/plots/chart";
import { firstChoice, type PlotChoice } from "../../../src/plots/plot_kinds";
import { TimeView } from "../../../src/plots/time_view";
import { channels, channelsOf } from "../../../src/state/channels";
import type { Happened } from "../../../src/state/happened";
import { History } from "../../../src/state/history";
import type { Shown } from "../../../src/state/shown";
import { strings } from "../../../src/strings";
import { drawnOn, fakeCanvases, forgetDrawn, textsOn } from "./fake_canvas";

const kRate = 60;
const index = (quantity: Parameters<typeof channelsOf>[0], part: number) => channelsOf(quantity)[part]!.index;
let history: History;
let view: TimeView;
let happened: Happened[];
let selects = false;
let drawn: Chart | undefined;

/// Ten seconds that all hold the same values, but for what `change` says of single samples.
function fill(values: ReadonlyMap<number, number>, change: (sample: number, row: Float64Array) => void = () => {}): void {
  for (let i = 0; i <= 10 * kRate; ++i) {
    const row = new Float64Array(channels.length);
    row[index("factor", 0)] = 1;
    for (const [channel, value] of values) row[channel] = value;
    change(i, row);
    history.push(i / kRate, row);
  }
}
function make(kind: Parameters<typeof chart>[0], choice: Partial<PlotChoice> = {}): Chart {
  const shown = { history, happened, utcOffset: 0 } as unknown as Shown;
  drawn = chart(kind, shown, view, { ...firstChoice, ...choice }, "dark", () => selects);
  document.body.replaceChildren(drawn.element);
  return drawn;
}
const canvasOf = (of: Chart) => of.element.querySelector("canvas")!;
const press = (on: Chart, key: string, shiftKey = false) => on.element.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey, bubbles: true, cancelable: true }));
const tip = () => document.querySelector<HTMLElement>(".plot-tip")!;
const lines = () => [...tip().querySelectorAll("div")].map((line) => line.textContent);
const spoken = () => document.querySelector("[role=status]")!.textContent!;
/// uPlot draws in a microtask.
const settled = () => new Promise((resolve) => setTimeout(resolve));

beforeAll(fakeCanvases);
beforeEach(() => {
  vi.spyOn(HTMLElement.prototype, "clientWidth", "get").mockReturnValue(600);
  vi.spyOn(HTMLElement.prototype, "clientHeight", "get").mockReturnValue(200);
  drawn?.dispose();
  history = new History(channels.length, 660);
  view = new TimeView(history, 10);
  happened = [];
  selects = false;
});

describe("a plot with the focus", () => {
  it("can be reached by keyboard, and says how it is read", () => {
    const force = make("force");
    expect(force.element.tabIndex).toBe(0);
    expect(force.element.getAttribute("aria-label")).toContain(strings.plots.keys);
  });

  it("shows and says its values by arrow keys: in time", async () => {
    const ramp = index("digit_force", 1);
    fill(new Map(), (i, row) => (row[ramp] = i / kRate));
    const force = make("force");
    await settled();
    expect(tip().hidden).toBe(true);
    press(force, "End");
    expect(tip().hidden).toBe(false);
    expect(lines()).toEqual(["Index10.00 N"]);
    for (let i = 0; i < 10; ++i) press(force, "ArrowLeft");
    expect(spoken()).toBe("-1.00 s, Index 9.00 N");
    press(force, "Home");
    press(force, "ArrowRight");
    expect(spoken()).toBe("-9.90 s, Index 0.10 N");
    expect(lines()).toEqual(["Index0.10 N"]);
  });

  it("names the curve nearest to the cursor first, by arrow keys up and down", async () => {
    fill(new Map([[index("torque", 0), 0.3], [index("torque", 1), -0.3]]));
    const torque = make("torque", { digit: 0 });
    await settled();
    for (let i = 0; i < 20; ++i) press(torque, "ArrowUp");
    expect(lines()[0]).toMatch(/^Thumb flexion0\.300/);
    for (let i = 0; i < 20; ++i) press(torque, "ArrowDown");
    expect(lines()[0]).toMatch(/^Thumb spread-0\.300/);
  });

  it("lets go of its values with the focus, and leaves other keys alone", () => {
    fill(new Map([[index("torque", 0), 0.3]]));
    const torque = make("torque", { digit: 0 });
    const other = new KeyboardEvent("keydown", { key: "p", bubbles: true, cancelable: true });
    torque.element.dispatchEvent(other);
    expect(other.defaultPrevented).toBe(false);
    expect(tip().hidden).toBe(true);
    press(torque, "ArrowLeft");
    expect(tip().hidden).toBe(false);
    torque.element.dispatchEvent(new Event("blur"));
    expect(tip().hidden).toBe(true);
  });
});

describe("a plot under the pointer", () => {
  it("shows the values there until the pointer leaves, the nearest curve first, also while new ones come", async () => {
    fill(new Map([[index("torque", 0), 0.3], [index("torque", 1), -0.3]]));
    const torque = make("torque", { digit: 0 });
    await settled();
    const over = torque.element.querySelector<HTMLElement>(".u-over")!;
    const point = (clientX: number, clientY: number) => over.dispatchEvent(new MouseEvent("mousemove", { clientX, clientY, bubbles: true }));
    over.dispatchEvent(new MouseEvent("mouseenter"));
    point(5, 1);
    await settled();
    expect(tip().hidden).toBe(false);
    expect(lines()[0]).toMatch(/^Thumb flexion/);
    point(5, 150);
    await settled();
    expect(lines()[0]).toMatch(/^Thumb spread/);
    const row = new Float64Array(channels.length).fill(0.25);
    for (let i = 1; i <= 11 * kRate; ++i) history.push(10 + i / kRate, row);
    torque.draw();
    await settled();
    expect(lines()[0]).toContain("0.250 Nm");
    over.dispatchEvent(new MouseEvent("mouseleave"));
    await settled();
    expect(tip().hidden).toBe(true);
  });
});

describe("a time in a plot", () => {
  const seconds = () => view.selection && [view.selection.from, view.selection.to].map((time) => time.toFixed(2));

  it("is selected by keys with Shift, zoomed to and left again", async () => {
    fill(new Map([[index("digit_force", 1), 2]]));
    const force = make("force");
    await settled();
    press(force, "End");
    for (let i = 0; i < 10; ++i) press(force, "ArrowLeft", true);
    expect(seconds()).toEqual(["9.00", "10.00"]);
    press(force, "Enter");
    expect(view.zoom).toEqual(view.selection);
    press(force, "Backspace");
    expect(view.zoom).toBeUndefined();
    press(force, "Delete");
    expect(view.selection).toBeUndefined();
    press(force, "ArrowLeft"); // without Shift nothing is selected
    expect(view.selection).toBeUndefined();
  });

  it("is told to others while the cursor is there", async () => {
    fill(new Map([[index("digit_force", 1), 2]]));
    const told: (number | null)[] = [];
    view.on(["pointed"], () => told.push(view.pointed));
    const force = make("force");
    await settled();
    press(force, "Home");
    force.element.dispatchEvent(new Event("blur"));
    expect(told).toEqual([0, null]);
  });

  it("with an event is found by Page Up and Page Down, which say it", async () => {
    happened = [{ time: 2, code: "stopped", text: "stopped the torque" }, { time: 7, code: "set", text: "stiffness = 2" }];
    fill(new Map([[index("digit_force", 1), 2]]));
    const force = make("force");
    await settled();
    press(force, "PageUp");
    expect(spoken()).toContain("stiffness = 2");
    press(force, "PageUp");
    expect(spoken()).toContain("stopped the torque");
    press(force, "PageDown");
    expect(spoken()).toContain("stiffness = 2");
  });
});

describe("what is not sent", () => {
  beforeEach(() => {
    vi.spyOn(HTMLElement.prototype, "clientWidth", "get").mockReturnValue(600);
    vi.spyOn(HTMLElement.prototype, "clientHeight", "get").mockReturnValue(200);
  });
  afterEach(() => vi.restoreAllMocks());

  it("is hatched, and the words stand there and beside the values", async () => {
    fill(new Map([[index("force_raw", 5), 3]]), (i, row) => i >= 300 && (row[index("factor", 0)] = 0));
    const force = make("segment");
    await settled();
    expect(textsOn(canvasOf(force))).toContain(strings.plots.notSent);
    press(force, "End");
    expect(spoken()).toContain(strings.plots.notSent);
    press(force, "Home");
    expect(spoken()).not.toContain(strings.plots.notSent);
  });

  it("is said nowhere while forces are sent", async () => {
    fill(new Map([[index("force_raw", 5), 3]]));
    const force = make("segment");
    await settled();
    expect(textsOn(canvasOf(force))).not.toContain(strings.plots.notSent);
  });
});

describe("the ends of the digits' curves", () => {
  afterEach(() => vi.restoreAllMocks());

  const cases = [[600, strings.digits], [300, strings.digitLetters]] as const;
  it.each(cases)("tell the digits apart by more than colour: %d pixels wide", async (width, names) => {
    vi.spyOn(HTMLElement.prototype, "clientWidth", "get").mockReturnValue(width);
    vi.spyOn(HTMLElement.prototype, "clientHeight", "get").mockReturnValue(200);
    fill(new Map([[index("digit_force", 1), 2], [index("digit_force", 4), 1]]));
    const force = make("force");
    await settled();
    const known = new Set([...strings.digits, ...strings.digitLetters]);
    expect(new Set(textsOn(canvasOf(force)).filter((text) => known.has(text)))).toEqual(new Set([names[1], names[4]]));
  });
});

describe("what lies beyond a plot", () => {
  it("is marked at its upper edge, with how far it goes", async () => {
    const raw = index("force_raw", 5);
    fill(new Map([[raw, 2]]), (i, row) => i >= 300 && i < 320 && (row[raw] = i === 310 ? 34.25 : 20));
    const force = make("segment");
    await settled();
    const canvas = canvasOf(force);
    expect(textsOn(canvas)).toContain(strings.plots.beyond("34.3", "N"));
    const marks = drawnOn(canvas).filter((one) => one.what === "fill").length;
    forgetDrawn(canvas);
    history.clear();
    fill(new Map([[raw, 2]]));
    force.draw();
    await settled();
    expect(textsOn(canvas).length).toBeGreaterThan(0);
    expect(textsOn(canvas).some((text) => text.includes(strings.plots.beyond("", "").slice(0, 8)))).toBe(false);
    expect(drawnOn(canvas).filter((one) => one.what === "fill").length).toBe(marks - 1);
  });
});
