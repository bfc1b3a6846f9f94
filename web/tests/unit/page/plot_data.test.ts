// SPDX-License-Identifier: Apache-2.0
// What the plots make of the history and of events before anything is drawn.
import { describe, expect, it } from "vitest";
import { pointsOf } from "../../../src/plots/decimate";
import { clustersOf } from "../../../src/plots/event_clusters";
import { curvesOf, firstChoice, kindsOf, plotSubjects, type Curve } from "../../../src/plots/plot_kinds";
import { polylines } from "../../../src/plots/polylines";
import { statisticsOf } from "../../../src/plots/statistics";
import { leftOut, notSent, pausesOf } from "../../../src/plots/stretches";
import { decimalsOf, labelPlaces, multiples, niceStep, timeStep } from "../../../src/plots/ticks";
import { TimeView } from "../../../src/plots/time_view";
import { channels, channelsOf } from "../../../src/state/channels";
import type { Happened } from "../../../src/state/happened";
import { capacityFor, History } from "../../../src/state/history";
import { strings } from "../../../src/strings";
import { random } from "./random";

const kRate = 60;
const seed = 20261128;
const curve = curvesOf("force", firstChoice, "dark")[1]!;
const factor = channelsOf("factor")[0]!.index;

function historyOf(seconds: number, value: (i: number) => number, sent: (i: number) => number = () => 1): History {
  const history = new History(channels.length, capacityFor(seconds));
  const row = new Float64Array(channels.length);
  for (let i = 0; i <= seconds * kRate; ++i) {
    row[curve.channel.index] = value(i);
    row[factor] = sent(i);
    history.push(i / kRate, row);
  }
  return history;
}

describe("a curve with more samples than pixels", () => {
  it("keeps every peak, wherever it is, and the same ones as time goes on", () => {
    const next = random(seed);
    for (let round = 0; round < 6; ++round) {
      const peak = Math.floor(next() * 300 * kRate);
      const trough = Math.floor(next() * 300 * kRate);
      const history = historyOf(300, (i) => (i === peak ? 9 : i === trough ? -9 : 1));
      const { time, values } = pointsOf(history, [curve], { from: 0, to: 300 }, 400);
      const where = `seed ${seed}, round ${round}`;
      expect(time.length, where).toBeLessThanOrEqual(2 * 401);
      if (peak !== trough) expect(Math.min(...values[0]!), where).toBe(-9);
      expect(Math.max(...values[0]!), where).toBe(9);
      expect(Math.abs(time[values[0]!.indexOf(9)]! - peak / kRate), where).toBeLessThanOrEqual(300 / 400);
      for (let i = 1; i < time.length; ++i) expect(time[i]!, where).toBeGreaterThanOrEqual(time[i - 1]!);
    }
  });

  it("has the same bins as the curve passes", () => {
    const next = random(seed);
    const noise = Array.from({ length: 301 * kRate }, () => next());
    const history = historyOf(300, (i) => noise[i]!);
    const before = pointsOf(history, [curve], { from: 0, to: 299 }, 200);
    const after = pointsOf(history, [curve], { from: 1, to: 300 }, 200);
    const shared = [...after.time].slice(4, -4).filter((time) => before.time.includes(time));
    expect(shared.length).toBeGreaterThan(after.time.length - 16);
  });

  it("is drawn whole where there is room", () => {
    const history = historyOf(10, (i) => i);
    expect(pointsOf(history, [curve], { from: 2, to: 3 }, 400).values[0]!.length).toBe(kRate + 2);
  });

  it("takes a value that is not known only where there is no other", () => {
    const history = historyOf(300, (i) => (i % 7 === 0 || i > 9000 ? NaN : 2));
    const { values } = pointsOf(history, [curve], { from: 0, to: 300 }, 200);
    expect(values[0]!.slice(0, 100).every((value) => value === 2)).toBe(true);
    expect(values[0]!.at(-1)).toBeNaN();
  });
});

describe("what is left out of a curve", () => {
  it("are unknown values and, of forces, zeros", () => {
    expect(leftOut([0, 0, 1, NaN, 0, 2], true)).toEqual([[0, 1], [3, 4]]);
    expect(leftOut([0, 0, 1, NaN, 0, 2], false)).toEqual([[3, 3]]);
  });

  it("are pauses between samples", () => {
    const history = new History(channels.length, 10);
    for (const time of [1, 1.1, 2, 2.1]) history.push(time, []);
    expect(pausesOf(history.time(), { from: 0, to: 3 }, history)).toEqual([{ from: 1.1, to: 2 }]);
  });

  it("leaves the other parts as lines of their own", () => {
    const points = { time: Float64Array.of(0, 1, 2, 3, 4, 5, 6, 7), values: [Float32Array.of(1, 2, 0, 0, 0, 3, NaN, 4)] };
    expect(polylines(points, 0, [], true)).toEqual([[[0, 1], [1, 2], [2, 0]], [[4, 0], [5, 3]]]);
    expect(polylines(points, 0, [{ from: 0, to: 1 }], false)).toEqual([[[1, 2], [2, 0], [3, 0], [4, 0], [5, 3]]]);
  });
});

it("what is not sent are the times in which the factor is zero", () => {
  const history = historyOf(10, () => 1, (i) => ((i >= 60 && i < 120) || i >= 540 ? 0 : 1));
  expect(notSent(history, { from: 0, to: 10 })).toEqual([{ from: 1, to: 2 }, { from: 9, to: 10 }]);
  expect(notSent(history, { from: 3, to: 8 })).toEqual([]);
});

describe("the statistics of a selection", () => {
  it("are those of its known values", () => {
    const values = [5, 1, -4, NaN, 2, 9];
    const history = historyOf(1, (i) => values[i] ?? 0);
    const found = statisticsOf(history, { ...curve, scale: 2 } as Curve, { from: 1 / kRate, to: 4 / kRate });
    expect(found).toMatchObject({ count: 3, first: 2, last: 4, peak: -8 });
    expect(found.mean).toBeCloseTo(-2 / 3, 6);
    expect(found.deviation).toBeCloseTo(Math.sqrt(((2 + 2 / 3) ** 2 + (-8 + 2 / 3) ** 2 + (4 + 2 / 3) ** 2) / 2), 6);
  });

  it("are not known without values", () => {
    const found = statisticsOf(historyOf(1, () => NaN), curve, { from: 0, to: 1 });
    expect([found.count, found.mean, found.peak, found.deviation]).toEqual([0, NaN, NaN, NaN]);
  });
});

describe("names at the ends of curves", () => {
  it("never overlap, stay inside, and stand in the curves' order", () => {
    const next = random(seed);
    for (let round = 0; round < 200; ++round) {
      const wishes = Array.from({ length: 1 + Math.floor(next() * 8) }, () => 200 * next());
      const places = labelPlaces(wishes, 14, 10, 190)!;
      const order = wishes.map((_, i) => i).sort((a, b) => wishes[a]! - wishes[b]!);
      const where = `seed ${seed}, round ${round}`;
      for (const place of places) {
        expect(place, where).toBeGreaterThanOrEqual(17 - 1e-9);
        expect(place, where).toBeLessThanOrEqual(183 + 1e-9);
      }
      for (let i = 1; i < order.length; ++i) expect(places[order[i]!]! - places[order[i - 1]!]!, where).toBeGreaterThanOrEqual(14 - 1e-9);
    }
  });

  it("stand where they want to, if they can, and nowhere without room", () => {
    expect(labelPlaces([100, 50], 14, 0, 200)).toEqual([100, 50]);
    expect(labelPlaces([1, 2, 3], 14, 0, 40)).toBeUndefined();
  });
});

describe("ticks", () => {
  it("are round and no more than have room", () => {
    expect([0.011, 0.3, 1, 4, 6].map(niceStep)).toEqual([0.02, 0.5, 1, 5, 10]);
    for (const [seconds, count] of [[10, 6], [10, 3], [60, 8], [60, 2], [300, 6], [300, 2], [0.4, 5]] as const) {
      const step = timeStep(seconds, count);
      expect(multiples(-seconds, 0, step).length, `${seconds} s`).toBeLessThanOrEqual(count + 1);
    }
    expect(timeStep(300, 6) % 60).toBe(0);
    expect(multiples(-1, 1, 0.5)).toEqual([-1, -0.5, 0, 0.5, 1]);
    expect([10, 1, 0.5, 0.02].map(decimalsOf)).toEqual([0, 0, 1, 2]);
  });
});

describe("events", () => {
  const at = (time: number, code = "set"): Happened => ({ time, code, text: "" });
  const label = strings.replay.kinds;

  it("that follow soon are one flag with their number", () => {
    const found = clustersOf([at(1), at(1.2), at(1.4), at(5, "marker"), at(20)], { from: 0, to: 10 }, 1);
    expect(found.map((one) => one.label)).toEqual([strings.plots.several(label["set"]!, 3), label["marker"]]);
  });

  it("of several kinds take the most serious one's look", () => {
    const [found] = clustersOf([at(1), at(1.1, "stopped"), at(1.2, "marker")], { from: 0, to: 10 }, 1);
    expect(found).toMatchObject({ kind: "bad", label: strings.plots.events(3) });
  });
});

describe("the shown time", () => {
  it("is the newest seconds, until a part is zoomed, which stands still", () => {
    const history = historyOf(20, () => 1);
    const view = new TimeView(history, 10);
    expect(view.span).toEqual({ from: 10, to: 20 });
    view.zoom = { from: 12, to: 13 };
    history.push(25, []);
    expect(view.span).toEqual({ from: 12, to: 13 });
    view.seconds = 20;
    expect(view.span).toEqual({ from: 5, to: 25 });
  });

  it("lets go of what the history no longer has", () => {
    const history = historyOf(10, () => 1);
    const view = new TimeView(history, 10);
    view.zoom = view.selection = { from: 1, to: 2 };
    view.refresh();
    expect([view.zoom, view.selection]).toEqual([{ from: 1, to: 2 }, { from: 1, to: 2 }]);
    history.clear();
    history.push(100, []);
    view.refresh();
    expect([view.zoom, view.selection]).toEqual([undefined, undefined]);
  });
});

it("curves of one digit have a colour or a dash of their own", () => {
  for (const kind of plotSubjects.flatMap((subject) => kindsOf[subject])) {
    const looks = curvesOf(kind, firstChoice, "light").map(({ colour, width, dash }) => `${colour} ${width} ${dash.join()}`);
    expect(new Set(looks).size, kind).toBe(looks.length);
  }
});
