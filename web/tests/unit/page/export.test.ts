// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { csvOf, figureOf } from "../../../src/plots/export";
import { figureSvg } from "../../../src/plots/figure";
import { firstChoice } from "../../../src/plots/plot_kinds";
import { kDigits, kJoints } from "../../../src/state/channels";
import { Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";
import { digitColours } from "../../../src/theme";
import { kSegments } from "../../../src/view3d/segments";
import type { Shapes } from "../../../src/view3d/shapes";

describe("the CSV", () => {
  it("has each value in the column of its segment or joint", () => {
    const store = new Store();
    store.setPhase("open");
    const names = { segmentName: Array.from({ length: kSegments }, (_, i) => `segment-${i}`), jointName: Array.from({ length: kJoints }, (_, i) => `joint-${i}`) };
    store.setGeometry(names as unknown as Shapes, 1);
    const joints = (first: number) => Array.from({ length: kJoints }, (_, joint) => first + joint);
    const contact = Array.from({ length: kSegments }, (_, segment) => ({ segment, touching: true, force: 200 + segment, forceRaw: 100 + segment, normal: [0, 0, 1] }));
    store.receive(create(ToPageSchema, { what: { case: "state", value: { scene: "press_teapot" } } }));
    const value = { tick: 1n, time: 1, factor: 0.5, contact, torque: joints(300), hcpAngle: joints(400), gdpAngle: joints(500), stiffness: 1200 };
    store.receive(create(ToPageSchema, { what: { case: "tick", value } }));
    const [head, row] = csvOf(store, { from: 0, to: 2 }).trimEnd().split("\r\n").map((line) => line.split(","));
    const cells = new Map(head!.map((name, i) => [name, row![i]]));
    expect(cells.size).toBe(2 + 1 + 2 * kSegments + 3 * kJoints + kDigits + 3);
    expect([cells.get("factor"), cells.get("verdict"), cells.get("scene")]).toEqual(["0.5", "steady", "press_teapot"]);
    expect(cells.get("digit_force index [N]")).toBe(String(0.5 * (203 + 204 + 205)));
    expect(cells.get("station_time [s]")).toBe("1.0000");
    expect(cells.get("stiffness [N/mm]")).toBe("1.2");
    for (let i = 0; i < kSegments; ++i) {
      expect(cells.get(`force_raw segment-${i} [N]`)).toBe(String(100 + i));
      expect(cells.get(`force_sent segment-${i} [N]`)).toBe(String(0.5 * (200 + i)));
    }
    for (let i = 0; i < kJoints; ++i) {
      expect(cells.get(`torque joint-${i} [Nm]`)).toBe(String(300 + i));
      expect(Number(cells.get(`angle_measured joint-${i} [deg]`))).toBeCloseTo(((400 + i) * 180) / Math.PI, 1);
      expect(Number(cells.get(`angle_shown joint-${i} [deg]`))).toBeCloseTo(((500 + i) * 180) / Math.PI, 1);
    }
  });
});

/// A store that has seen ten seconds of an index finger that presses, and that was stopped after eight.
function pressed(): Store {
  const store = new Store();
  store.setPhase("open");
  const tell = (what: Parameters<typeof create<typeof ToPageSchema>>[1]) => store.receive(create(ToPageSchema, what));
  const past = [{ unixTime: 1000 + 8, code: "stopped", text: "stopped the torque" }, { unixTime: 1000 + 3, code: "upload", text: "no curve changes" }];
  tell({ what: { case: "welcome", value: { unixTime: 1000, clock: 0, past } } });
  tell({ what: { case: "state", value: { scene: "press_teapot", deviceName: "Exo <5>", deviceSimulated: true, value: [{ key: "force.law", value: '"hooke"' }] } } });
  for (let i = 0; i <= 600; ++i) {
    const factor = i < 480 ? 1 : 0;
    tell({ what: { case: "tick", value: { tick: BigInt(i + 1), time: i / 60, factor, contact: [{ segment: 5, touching: true, force: 2, forceRaw: 3, normal: [0, 0, 1] }] } } });
  }
  return store;
}
const span = { from: 0, to: 10 };
const svgOf = (store: Store, choice = firstChoice) => figureSvg(figureOf(store, choice, span)).text;
const textsOf = (svg: string) => [...new DOMParser().parseFromString(svg, "image/svg+xml").querySelectorAll("text")].map((one) => one.textContent);

describe("the figure", () => {
  it("states title, scene, settings, device, axes with units, and the curves' names, as text", () => {
    const all = textsOf(svgOf(pressed()));
    const { facts, titles } = strings.plots;
    for (const fact of [facts.scene("press_teapot"), facts.law(strings.force.laws["hooke"]!), facts.simulated("Exo <5>")]) {
      expect(all.some((text) => text?.includes(fact)), fact).toBe(true);
    }
    expect(all).toEqual(expect.arrayContaining([titles.force, strings.plots.axis(strings.plots.axes.force, "N"), strings.plots.axis(strings.plots.time, "s")]));
    expect(all).toEqual(expect.arrayContaining([...strings.digits]));
    const computed = strings.digits.map(strings.plots.computed);
    expect(textsOf(svgOf(pressed(), { ...firstChoice, computed: new Array<boolean>(5).fill(true) }))).toEqual(expect.arrayContaining(computed));
  });

  it("states what was in force in the steps that it shows, not what is when it is saved", () => {
    const store = pressed();
    const tell = (what: Parameters<typeof create<typeof ToPageSchema>>[1]) => store.receive(create(ToPageSchema, what));
    const state = (scene: string, law: string) =>
      tell({ what: { case: "state", value: { scene, deviceName: "Exo <5>", deviceSimulated: true, value: [{ key: "force.law", value: `"${law}"` }] } } });
    const steps = (from: number, stiffness: number) => {
      for (let i = 1; i <= 60; ++i) tell({ what: { case: "tick", value: { tick: BigInt(60 * from + i + 1), time: from + i / 60, factor: 1, stiffness } } });
    };
    state("pinch_ball", "hooke");
    steps(10, 500);
    state("pinch_ball", "duffing");
    steps(11, 2200);
    state("press_teapot", "kelvin_voigt");
    const { facts } = strings.plots;
    const laws = strings.force.laws;
    const factsIn = (from: number, to: number) => figureOf(store, firstChoice, { from, to }).facts;
    expect(factsIn(10.1, 11)).toEqual(expect.arrayContaining([facts.scene("pinch_ball"), facts.stiffness("0.5", "N/mm"), facts.law(laws["hooke"]!)]));
    expect(factsIn(11.1, 12)).toEqual(expect.arrayContaining([facts.stiffness("2.2", "N/mm"), facts.law(laws["duffing"]!)]));
    expect(factsIn(10.1, 12)).toEqual(
      expect.arrayContaining([
        facts.scene("pinch_ball"),
        facts.changed(facts.stiffness(facts.fromTo("0.5", "2.2"), "N/mm")),
        facts.changed(facts.law(`${laws["hooke"]}, ${laws["duffing"]}`)),
        facts.simulated("Exo <5>"),
      ]),
    );
    expect(factsIn(9, 11)).toContain(facts.changed(facts.scene("press_teapot, pinch_ball")));
  });

  it("says so where a part of what was in force is not known", () => {
    const store = new Store();
    store.setPhase("open");
    const tick = (i: number) => store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: BigInt(i + 1), time: i / 60, factor: 1 } } }));
    for (let i = 0; i < 60; ++i) tick(i);
    store.receive(create(ToPageSchema, { what: { case: "state", value: { scene: "press_teapot" } } }));
    for (let i = 60; i < 120; ++i) tick(i);
    const { facts } = strings.plots;
    const factsIn = (from: number, to: number) => figureOf(store, firstChoice, { from, to }).facts;
    expect(factsIn(0, 2)).toEqual(expect.arrayContaining([facts.scene("press_teapot"), facts.partly]));
    expect(factsIn(1, 2)).not.toContain(facts.partly);
    expect(factsIn(0, 0.5).some((fact) => fact.startsWith(facts.scene("")))).toBe(false);
  });

  it("has the curve of the finger that presses in its colour, and none for a force of zero", () => {
    const paths = [...svgOf(pressed()).matchAll(/<path d="([^"]*)" fill="none" stroke="([^"]*)"/g)].map(([, path, colour]) => ({ path: path!, colour }));
    expect(paths.length).toBe(5);
    for (const { path, colour } of paths) expect(path !== "", colour).toBe(colour === digitColours.light[1]);
  });

  it("marks events that change curves, and what is not sent", () => {
    const all = textsOf(svgOf(pressed(), { ...firstChoice, subject: "segments" }));
    expect(all).toContain(strings.replay.kinds["stopped"]);
    expect(all).not.toContain(strings.replay.kinds["upload"]);
    expect(all).toContain(strings.plots.notSent);
  });

  it("marks in their colour the peaks that lie beyond its plot, and states how far they go", () => {
    const marks = (svg: string) => [...svg.matchAll(/<polygon points="[^"]*" fill="([^"]*)"/g)].map(([, colour]) => colour);
    const store = pressed();
    expect(marks(svgOf(store, { ...firstChoice, subject: "segments" }))).toEqual([]);
    for (const [i, forceRaw] of [20, 3, 34.25].entries()) {
      const contact = [{ segment: 5, touching: true, force: 2, forceRaw, normal: [0, 0, 1] }];
      store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: BigInt(700 + i), time: 10 + (i + 1) / 60, factor: 1, contact } } }));
    }
    const svg = figureSvg(figureOf(store, { ...firstChoice, subject: "segments" }, { from: 0, to: 11 })).text;
    const own = digitColours.light[1]!.toLowerCase();
    expect(marks(svg)).toEqual([own, own]);
    expect(textsOf(svg)).toContain(strings.plots.beyond("34.3", "N"));
  });

  it("is a document without scripts, links or styles, whatever the texts", () => {
    const svg = svgOf(pressed());
    expect(svg).not.toMatch(/<script|href|<style|style="/);
    expect(svg).not.toContain("Exo <5>");
    expect(new DOMParser().parseFromString(svg, "image/svg+xml").querySelectorAll("svg").length).toBe(1);
  });

  it("of a recording says that it is one", () => {
    const store = pressed();
    Object.defineProperty(store, "recordedAt", { value: 1 });
    expect(textsOf(svgOf(store)).some((text) => text?.includes(strings.replay.watermark))).toBe(true);
  });
});
