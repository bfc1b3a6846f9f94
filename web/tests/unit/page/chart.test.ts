// SPDX-License-Identifier: Apache-2.0
import { beforeAll, beforeEach, describe, expect, it } from "vitest";
import { chart, type Chart } from "../../../src/plots/chart";
import { channels, channelsOf, kDigits } from "../../../src/state/channels";
import { History } from "../../../src/state/history";
import { strings } from "../../../src/strings";
import { drawnOn, fakeCanvases, forgetDrawn, textsOn } from "./fake_canvas";

const kRate = 60;
const all = new Array<boolean>(kDigits).fill(true);
const index = (quantity: Parameters<typeof channelsOf>[0], part: number) => channelsOf(quantity)[part]!.index;
let history: History;
let drawn: Chart | undefined;

/// Ten seconds that all hold the same values, but for what `change` says of single samples.
function fill(values: ReadonlyMap<number, number>, change: (sample: number, row: Float64Array) => void = () => {}): void {
  for (let i = 0; i <= 10 * kRate; ++i) {
    const row = new Float64Array(channels.length);
    for (const [channel, value] of values) row[channel] = value;
    change(i, row);
    history.push(i / kRate, row);
  }
}
function make(kind: Parameters<typeof chart>[0]): Chart {
  drawn = chart(kind, history, "dark", all);
  document.body.replaceChildren(drawn.element);
  return drawn;
}
const press = (on: Chart, key: string) => on.element.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
const tip = () => document.querySelector<HTMLElement>(".plot-tip")!;
const lines = () => [...tip().querySelectorAll("div")].map((line) => line.textContent);
const spoken = () => document.querySelector("[role=status]")!.textContent!;
/// uPlot draws in a microtask.
const settled = () => new Promise((resolve) => setTimeout(resolve));

beforeAll(fakeCanvases);
beforeEach(() => {
  drawn?.dispose();
  history = new History(channels.length, 660);
});

describe("a plot with the focus", () => {
  it("can be reached by keyboard, and says how it is read", () => {
    const force = make("force");
    expect(force.element.tabIndex).toBe(0);
    expect(force.element.getAttribute("aria-label")).toContain(strings.plots.keys);
  });

  it("shows and says its values by arrow keys: in time", async () => {
    const ramp = index("force_sent", 5);
    fill(new Map(), (i, row) => (row[ramp] = i / kRate));
    const force = make("force");
    await settled();
    expect(tip().hidden).toBe(true);
    press(force, "End");
    expect(tip().hidden).toBe(false);
    expect(lines()).toEqual(["Index tip sent10.00 N"]);
    for (let i = 0; i < 10; ++i) press(force, "ArrowLeft");
    expect(spoken()).toBe("-1.0 s, Index tip sent 9.00 N");
    press(force, "Home");
    press(force, "ArrowRight");
    expect(spoken()).toBe("-9.9 s, Index tip sent 0.10 N");
    expect(lines()).toEqual(["Index tip sent0.10 N"]);
  });

  it("names the curve nearest to the cursor first, by arrow keys up and down", async () => {
    fill(new Map([[index("torque", 0), 0.3], [index("torque", 5), -0.3]]));
    const torque = make("torque");
    await settled();
    for (let i = 0; i < 20; ++i) press(torque, "ArrowUp");
    expect(lines()[0]).toMatch(/^Thumb flexion0\.300/);
    for (let i = 0; i < 20; ++i) press(torque, "ArrowDown");
    expect(lines()[0]).toMatch(/^Index spread-0\.300/);
  });

  it("lets go of its values with the focus, and leaves other keys alone", () => {
    fill(new Map([[index("torque", 0), 0.3]]));
    const torque = make("torque");
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
    fill(new Map([[index("torque", 0), 0.3], [index("torque", 5), -0.3]]));
    const torque = make("torque");
    await settled();
    const over = torque.element.querySelector<HTMLElement>(".u-over")!;
    const point = (clientX: number, clientY: number) => over.dispatchEvent(new MouseEvent("mousemove", { clientX, clientY, bubbles: true }));
    over.dispatchEvent(new MouseEvent("mouseenter"));
    point(5, 1);
    await settled();
    expect(tip().hidden).toBe(false);
    expect(lines()[0]).toMatch(/^Thumb flexion/);
    point(5, 30);
    await settled();
    expect(lines()[0]).toMatch(/^Index spread/);
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

describe("what lies beyond a plot", () => {
  it("is marked at its upper edge, with how far it goes", async () => {
    const raw = index("force_raw", 5);
    fill(new Map([[raw, 2]]), (i, row) => i >= 300 && i < 320 && (row[raw] = i === 310 ? 34.25 : 20));
    const force = make("force");
    await settled();
    const canvas = force.canvas();
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
