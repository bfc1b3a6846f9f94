// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { happenings } from "../../../src/replay/event_list";
import { Overview, surveyOrder } from "../../../src/replay/overview";
import type { ChunkPlace } from "../../../src/replay/recording";
import { openRecording } from "../../../src/replay/recording";
import { SourceError } from "../../../src/replay/source";
import { bytesOf, event, forceAt, gap, geometry, kRate, madeRecording, plainDecoder, poses, setup, sourceOf } from "./made_recording";

const never = new AbortController().signal;
const chunk = (topics: readonly string[] = []): ChunkPlace => ({ offset: 0, length: 1, begin: 0, end: 0, topics: new Set(["/pose", ...topics]) });

describe("the overview", () => {
  it("reads events first, then the whole length coarsely, then the rest, and each chunk once", () => {
    const chunks = Array.from({ length: 10_000 }, (_, i) => chunk(i % 3000 === 7 ? ["/event"] : []));
    const [marked, coarse, rest] = surveyOrder({ chunks });
    expect(marked).toEqual([7, 3007, 6007, 9007]);
    expect(coarse!.length).toBeLessThan(250);
    const widest = coarse!.reduce((widest, at, i) => Math.max(widest, at - (coarse![i - 1] ?? 0)), 0);
    expect(widest).toBeLessThan(10_000 / 100);
    expect(new Set([...marked!, ...coarse!, ...rest!]).size).toBe(10_000);
    expect(marked!.length + coarse!.length + rest!.length).toBe(10_000);
  });

  it("has the largest force on each digit at each time", async () => {
    const { recording, decoder } = await madeRecording([setup(0), ...poses(0.01, 20)]);
    const overview = new Overview(recording);
    expect(overview.forcesAt(5)).toBe(undefined);
    let told = 0;
    await overview.fill(decoder, () => ++told, never);
    expect(told).toBeGreaterThan(0);
    expect(overview.progress).toBe(1);
    const width = recording.seconds / overview.bins;
    for (let time = 0.1; time < 19.9; time += 0.37) {
      const bin = overview.binAt(time);
      const inside = Array.from({ length: 20 * kRate }, (_, i) => 0.01 + i / kRate).filter((at) => overview.binAt(at) === bin);
      const largest = Math.max(...inside.map(forceAt));
      const forces = overview.forcesAt(time)!;
      expect(forces[1], `at ${time}, in ${inside.length} poses of ${width} s`).toBeCloseTo(largest, 4);
      expect(forces[0]).toBe(0);
    }
    expect(overview.largest).toBeCloseTo(1.5, 2);
  });

  it("lists events, stations and missing steps with the time that they cover", async () => {
    const { recording, decoder } = await madeRecording([
      geometry(0, 1, 200), setup(0, { deviceName: "beihang", deviceRateHz: 1000, start: { scene: "grasp_teapot" } }), ...poses(0.01, 4),
      gap(6, 801n, 1200n, "the ring was full"), ...poses(6.01, 8), event(7, "marker", "stimulus 1", "127.0.0.1"), event(7.5, "fault", "no_sample"),
    ]);
    const overview = new Overview(recording);
    await overview.fill(decoder, () => {}, never);
    expect(overview.rateAt(5)).toBe(200); // of the loop, not of the device
    expect(overview.holes).toEqual([{ begin: 4, end: 6, gap: { steps: 400, why: "the ring was full" } }]);
    const list = happenings(overview);
    expect(list.map(({ code, kind }) => [code, kind])).toEqual([["station", "other"], ["gap", "gap"], ["marker", "marker"], ["fault", "bad"]]);
    expect(list[0]!.text).toContain("grasp_teapot");
    expect(list[2]).toMatchObject({ time: 7, text: "stimulus 1" });
    expect(overview.forcesAt(5)).toBe(undefined); // no step
  });

  it("goes on where it was when its source is back, and counts nothing twice", async () => {
    const { recording, source, decoder } = await madeRecording([geometry(0, 1), setup(0), ...poses(0.01, 20), gap(21, 5n, 9n, "late"), event(22, "marker", "one")]);
    const overview = new Overview(recording);
    await overview.fill(decoder, () => (source.gone = overview.progress > 0), never);
    expect(overview.trouble).toBeInstanceOf(SourceError);
    expect(overview.progress).toBeLessThan(1);
    const read = overview.progress;
    source.gone = false;
    await overview.fill(decoder, () => expect(overview.progress).toBeGreaterThanOrEqual(read), never);
    expect([overview.trouble, overview.progress]).toEqual([undefined, 1]);
    expect([overview.events.length, overview.holes.length, overview.stations.length]).toEqual([1, 1, 1]);
  });

  it("of a single step is one bin", async () => {
    const { recording, decoder } = await madeRecording(poses(0, 0.01));
    const overview = new Overview(recording);
    await overview.fill(decoder, () => {}, never);
    expect(recording.seconds).toBe(0);
    expect(overview.forcesAt(0)![1]).toBeCloseTo(1, 5);
  });

  it("counts damaged chunks and reads the others; it ends when it is told to", async () => {
    const bytes = await bytesOf([setup(0), ...poses(0.01, 5)]);
    const { chunks } = await openRecording(sourceOf(bytes));
    bytes[chunks[3]!.offset + chunks[3]!.length - 5]! ^= 0xff;
    const recording = await openRecording(sourceOf(bytes));
    const overview = new Overview(recording);
    await overview.fill(plainDecoder(recording.layout), () => {}, never);
    expect(overview.damaged).toBe(1);
    expect(overview.progress).toBe(1);
    const other = new Overview(recording);
    const ended = new AbortController();
    await other.fill(plainDecoder(recording.layout), () => ended.abort(), ended.signal);
    expect(other.progress).toBeLessThan(1);
  });
});
