// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { beforeAll, describe, expect, it } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { csvOf, drawPicture, type Part } from "../../../src/plots/export";
import { legendOf, plotKinds, titleOf } from "../../../src/plots/plot_kinds";
import { kJoints } from "../../../src/state/channels";
import { Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";
import { digitColours } from "../../../src/theme";
import { kSegments } from "../../../src/view3d/segments";
import type { Shapes } from "../../../src/view3d/shapes";
import { drawnOn, fakeCanvases, textsOn, textWidth } from "./fake_canvas";

beforeAll(fakeCanvases);

describe("the CSV", () => {
  it("has each value in the column of its segment or joint", () => {
    const store = new Store();
    store.setPhase("open");
    const names = { segmentName: Array.from({ length: kSegments }, (_, i) => `segment-${i}`), jointName: Array.from({ length: kJoints }, (_, i) => `joint-${i}`) };
    store.setGeometry(names as unknown as Shapes, 1);
    const joints = (first: number) => Array.from({ length: kJoints }, (_, joint) => first + joint);
    const contact = Array.from({ length: kSegments }, (_, segment) => ({ segment, touching: true, force: 200 + segment, forceRaw: 100 + segment }));
    const value = { tick: 1n, time: 1, factor: 0.5, contact, torque: joints(300), hcpAngle: joints(400), gdpAngle: joints(500), stiffness: 1200 };
    store.receive(create(ToPageSchema, { what: { case: "tick", value } }));
    const [head, row] = csvOf(store).trimEnd().split("\r\n").map((line) => line.split(","));
    const cells = new Map(head!.map((name, i) => [name, row![i]]));
    expect(cells.size).toBe(3 + 2 * kSegments + 3 * kJoints);
    expect(cells.get("station_time [s]")).toBe("1.0000");
    expect(cells.get("stiffness [N/m]")).toBe("1200");
    for (let i = 0; i < kSegments; ++i) {
      expect(cells.get(`force_raw segment-${i} [N]`)).toBe(String(100 + i));
      expect(cells.get(`force_sent segment-${i} [N]`)).toBe(String(0.5 * (200 + i)));
    }
    for (let i = 0; i < kJoints; ++i) {
      expect(cells.get(`torque joint-${i} [Nm]`)).toBe(String(300 + i));
      expect(cells.get(`angle_measured joint-${i} [rad]`)).toBe(String(400 + i));
      expect(cells.get(`angle_shown joint-${i} [rad]`)).toBe(String(500 + i));
    }
  });
});

describe("the picture", () => {
  const plot = (width: number) => Object.assign(document.createElement("canvas"), { width, height: 100 });
  const parts = (width: number): Part[] => plotKinds.map((kind) => ({ title: titleOf(kind), legend: legendOf(kind), canvas: plot(width) }));

  it("says which colour is which digit, of those that are shown", () => {
    const picture = drawPicture(parts(900), [true, false, true, false, false], "light")!;
    const swatches = drawnOn(picture).filter((one) => one.what === "fillRect").slice(1);
    expect(swatches.map((one) => one.fill)).toEqual([digitColours.light[0], digitColours.light[2]]);
    const texts = drawnOn(picture).filter((one) => one.what === "fillText");
    expect(texts.slice(0, 2).map((one) => one.values[0])).toEqual([strings.digits[0], strings.digits[2]]);
    texts.slice(0, 2).forEach((text, i) => expect(Number(text.values[1])).toBeGreaterThan(Number(swatches[i]!.values[0]) + Number(swatches[i]!.values[2]) - 1));
  });

  it("holds each title and legend on a line of its own, and none runs out of it, however narrow the plots", () => {
    const picture = drawPicture(parts(120), new Array<boolean>(5).fill(true), "dark")!;
    const texts = drawnOn(picture).filter((one) => one.what === "fillText");
    for (const kind of plotKinds) expect(textsOn(picture)).toEqual(expect.arrayContaining([titleOf(kind), legendOf(kind)]));
    for (const text of texts) {
      const right = Number(text.values[1]) + textWidth(String(text.values[0]), Number(/([\d.]+)px/.exec(text.font)![1]));
      expect(right, String(text.values[0])).toBeLessThanOrEqual(picture.width);
    }
    const rows = texts.slice(strings.digits.length).map((text) => text.values[2]);
    expect(new Set(rows).size).toBe(2 * plotKinds.length);
    const images = drawnOn(picture).filter((one) => one.what === "drawImage");
    expect(images.map((one) => Number(one.values[2]) + 100).at(-1)).toBe(picture.height);
  });

  it("says that it is of a recording, and is as wide as the word needs", () => {
    const mark = strings.replay.watermark;
    const picture = drawPicture(parts(120), [true, false, false, false, false], "dark", mark)!;
    const text = drawnOn(picture).find((one) => one.what === "fillText" && one.values[0] === mark)!;
    expect(Number(text.values[1]) + textWidth(mark, Number(/([\d.]+)px/.exec(text.font)![1]))).toBeLessThanOrEqual(picture.width);
  });

  it("is none where nothing is plotted", () => {
    expect(drawPicture([], [true, true, true, true, true], "dark")).toBeNull();
  });
});
