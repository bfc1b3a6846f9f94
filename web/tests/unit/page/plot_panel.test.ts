// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { afterEach, beforeAll, beforeEach, describe, expect, it, vi } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import * as saving from "../../../src/panels/saving";
import * as figure from "../../../src/plots/figure";
import { firstChoice, titleOf, unitOf, type PlotKind } from "../../../src/plots/plot_kinds";
import { plotPanel, type PlotPanel } from "../../../src/plots/plot_panel";
import { csvOf } from "../../../src/plots/export";
import { Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";
import { fakeCanvases } from "./fake_canvas";

const words = strings.plots;
let store: Store;
let panel: PlotPanel;
const tick = (time: number) => store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: BigInt(1000 * time), time, factor: 1 } } }));
const press = (name: string) =>
  [...panel.element.querySelectorAll("button")].find((one) => (one.getAttribute("aria-label") ?? one.textContent) === name)!.click();
const follows = { ...firstChoice, computed: new Array<boolean>(5).fill(true) }; // no joint is sensed
const title = (kind: PlotKind, choice = follows) => words.axis(titleOf(kind, choice), unitOf(kind));
const entry = (digit: number) => panel.element.querySelector(`.plot-legend [data-digit="${digit}"]`)!;
const plots = () => [...panel.element.querySelectorAll("figcaption strong")].map((title) => title.textContent);

beforeAll(fakeCanvases);
beforeEach(async () => {
  localStorage.clear();
  store = new Store();
  store.setPhase("open");
  panel = plotPanel(store, "dark", store);
  document.body.replaceChildren(panel.element);
  await Promise.resolve(); // it is built when it has its place
});
afterEach(() => vi.restoreAllMocks());

describe("the plots", () => {
  it("pause, say so, and go on", () => {
    const badge = panel.element.querySelector<HTMLElement>(".paused")!;
    tick(1);
    press(words.pause);
    expect(store.paused).toBe(true);
    expect(badge.hidden).toBe(false);
    tick(2);
    expect(store.history.length).toBe(1);
    press(words.resume);
    expect(badge.hidden).toBe(true);
    tick(3);
    expect(store.history.length).toBe(2);
  });

  it("are those that were chosen, also when the page comes again", async () => {
    expect(plots()).toEqual([title("force")]);
    press(words.subjects.joints);
    const chosen = [title("torque"), title("angle")];
    expect(plots()).toEqual(chosen);
    panel = plotPanel(store, "dark", store);
    await Promise.resolve();
    expect(plots()).toEqual(chosen);
  });

  it("show the digit whose legend entry was pressed", () => {
    press(words.subjects.segments);
    press(strings.digits[3]!);
    expect(plots()).toEqual([title("segment", { ...follows, digit: 3 })]);
    expect(entry(3).getAttribute("aria-pressed")).toBe("true");
    expect(entry(1).getAttribute("aria-pressed")).toBe("false");
  });

  it("say which digits are computed, as soon as it is known", () => {
    store.receive(create(ToPageSchema, { what: { case: "state", value: { sensedJoint: [0, 1, 2, 4] } } }));
    expect([0, 1, 2, 3, 4].map((digit) => entry(digit).hasAttribute("data-computed"))).toEqual([false, false, true, true, true]);
    press(words.subjects.segments);
    press(strings.digits[2]!);
    expect(plots()[0]).toContain(words.computed(strings.digits[2]!));
  });

  it("show 10 s, a minute or five", () => {
    const chosen = () => [...panel.element.querySelectorAll(`[aria-label="${words.window}"] [aria-pressed=true]`)].map((one) => one.textContent);
    expect(chosen()).toEqual([words.windows(10)]);
    press(words.windows(300));
    expect(chosen()).toEqual([words.windows(300)]);
  });

  it("are saved as CSV by their button", async () => {
    const save = vi.spyOn(saving, "saveBlob").mockImplementation(() => {});
    tick(1);
    press(words.csvLong);
    const [name, blob] = save.mock.calls[0]!;
    expect(name).toMatch(/^phalanx-\d{8}-\d{6}\.csv$/);
    expect(await blob.text()).toBe(csvOf(store, { from: -9, to: 1 }));
  });

  it("are saved as a figure; those of a recording under the recorded moment", async () => {
    const save = vi.spyOn(saving, "saveBlob").mockImplementation(() => {});
    tick(1);
    press(words.svgLong);
    Object.defineProperty(store, "recordedAt", { value: new Date(2026, 10, 27, 14, 3, 5).getTime() / 1000 });
    press(words.csvLong);
    press(words.svgLong);
    const names = save.mock.calls.map(([name]) => name);
    expect(names[0]).toMatch(/^phalanx-\d{8}-\d{6}\.svg$/);
    expect(names.slice(1)).toEqual(["phalanx-recording-20261127-140305.csv", "phalanx-recording-20261127-140305.svg"]);
    const [live, recorded] = await Promise.all([save.mock.calls[0]![1].text(), save.mock.calls[2]![1].text()]);
    expect(live).not.toContain(strings.replay.watermark);
    expect(recorded).toContain(strings.replay.watermark);
  });

  it("say so where the browser cannot make their picture, until it can", async () => {
    const save = vi.spyOn(saving, "saveBlob").mockImplementation(() => {});
    const report = vi.spyOn(console, "error").mockImplementation(() => {});
    const rasterised = vi.spyOn(figure, "rasterised").mockRejectedValueOnce(new Error("no memory")).mockResolvedValueOnce(null).mockResolvedValue(new Blob());
    const said = [...panel.element.querySelectorAll<HTMLElement>("[role=alert]")].find((one) => one.textContent === words.pngFailed)!;
    tick(1);
    const shown: boolean[] = [];
    for (let i = 0; i < 3; ++i) {
      press(words.pngLong);
      await vi.waitFor(() => expect(report.mock.calls.length + save.mock.calls.length).toBe(i + 1));
      shown.push(!said.hidden);
    }
    expect(shown).toEqual([true, true, false]);
    expect(rasterised).toHaveBeenCalledTimes(3);
  });

  it("leave nothing behind when they are disposed of", async () => {
    const drawn = () => panel.element.querySelectorAll(".uplot").length;
    expect(drawn()).toBe(1);
    panel.dispose();
    expect(drawn()).toBe(0);
    panel = plotPanel(store, "dark", store);
    panel.dispose(); // before they are built
    await Promise.resolve();
    expect(drawn()).toBe(0);
  });

  it("say that they are old where there is no connection", () => {
    const said = panel.element.querySelector<HTMLElement>(".plot-offline")!;
    expect(said.hidden).toBe(true);
    store.setPhase("waiting");
    expect(said.hidden).toBe(false);
    expect(said.textContent).toBe(words.old.offline);
  });

  it("say that nothing comes, or that nothing is measured", () => {
    let now = 0;
    store = new Store(() => now);
    store.setPhase("open");
    panel = plotPanel(store, "dark", store);
    const said = panel.element.querySelector<HTMLElement>(".plot-offline")!;
    const area = panel.element.querySelector(".plot-area")!;
    tick(1);
    expect(said.hidden).toBe(true);
    now += 5000; // of the page's own, which did not listen
    store.freshness.beat(now);
    panel.update();
    expect(said.hidden).toBe(true);
    expect(area.classList.contains("plot-dead"), "old all the same").toBe(true);
    for (let frame = 0; frame < 40; ++frame) store.freshness.beat((now += 16));
    panel.update();
    expect(said.textContent).toBe(words.old.silent);
    expect(area.classList.contains("plot-dead")).toBe(true);
    store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: 2000n, time: 2, factor: 1, status: 1 << 12 } } }));
    expect(said.textContent).toBe(words.old.unmeasured);
    tick(3);
    expect(said.hidden).toBe(true);
    expect(area.classList.contains("plot-dead")).toBe(false);
  });
});
