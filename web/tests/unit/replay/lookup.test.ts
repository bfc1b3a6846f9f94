// SPDX-License-Identifier: Apache-2.0
import { fromBinary } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { ChunkCache } from "../../../src/replay/chunk_cache";
import { Lookup } from "../../../src/replay/lookup";
import { change, event, geometry, madeRecording, poses, setup } from "./made_recording";

/// Two stations with a pause between them; the first one's object is changed once.
async function twoStations() {
  const messages = [
    geometry(0, 1), setup(0.001), ...poses(0.02, 4), geometry(4.001, 2), change(4.002, { number: 1n }), ...poses(4.02, 7, 300),
    event(6.5, "ended", "late"), // written after later steps
    geometry(9, 3), setup(9.001), ...poses(9.02, 12),
  ];
  const { recording, decoder, source } = await madeRecording(messages);
  const cache = new ChunkCache(recording, decoder);
  const times = messages.filter(({ topic }) => topic === "/pose").map(({ time }) => time);
  return { recording, source, cache, lookup: new Lookup(recording, cache), times };
}

const kSlack = 1e-6; // a message's time is kept in nanoseconds

describe("the place of a moment", () => {
  it("has the newest pose at that moment or before, wherever one looks", async () => {
    const { lookup, times } = await twoStations();
    let seed = 7;
    for (let i = 0; i < 300; ++i) {
      seed = (seed * 48271) % 2147483647;
      const at = 13 * (seed / 2147483647);
      const wanted = times.filter((time) => time <= at).at(-1);
      const found = await lookup.last("/pose", at);
      if (wanted === undefined) expect(found).toBe(undefined);
      else expect(Math.abs(found!.time - wanted), `at ${at}`).toBeLessThan(kSlack);
      const next = times.find((time) => time > at);
      const after = await lookup.poseAfter(at);
      if (next === undefined) expect(after).toBe(undefined);
      else expect(Math.abs(after!.time - next), `after ${at}`).toBeLessThan(kSlack);
    }
  });

  it("has the geometry in force, also where it was written long before", async () => {
    const { lookup } = await twoStations();
    const revision = async (at: number) => {
      const found = await lookup.last("/geometry", at);
      return found ? fromBinary(GeometrySchema, found.value).revision : 0;
    };
    expect(await revision(0.5)).toBe(1);
    expect(await revision(3.9)).toBe(1);
    expect(await revision(4.0)).toBe(1);
    expect(await revision(4.1)).toBe(2);
    expect(await revision(8.9)).toBe(2);
    expect(await revision(9.1)).toBe(3);
    expect(await revision(12)).toBe(3);
    expect(await revision(1)).toBe(1); // and back
  });

  it("knows when another geometry comes, or when to look again", async () => {
    const { lookup } = await twoStations();
    let at = 0.5;
    let steps = 0;
    while (at < 4.001 - kSlack && ++steps < 100) {
      const next = lookup.next(["/geometry"], at);
      expect(next).toBeGreaterThan(at);
      expect(next).toBeLessThan(4.001 + kSlack);
      await lookup.load(next, next);
      at = next;
    }
    expect(at).toBeCloseTo(4.001, 6);
    await lookup.load(0, 12);
    expect(lookup.next(["/geometry"], 4.001)).toBeCloseTo(9, 6);
    expect(lookup.next(["/geometry"], 9)).toBe(Infinity);
    expect(lookup.next(["/change"], 0)).toBeCloseTo(4.002, 6);
  });

  it("is found where chunks overlap in time", async () => {
    // An event is written late, so that the chunk before ends after geometry, station and poses of the chunk behind it.
    const messages = [
      geometry(0, 1), setup(0.001, { deviceName: "one" }), ...poses(0.02, 4), event(4.003, "ended", "late".repeat(300)),
      geometry(4.001, 2), setup(4.001, { deviceName: "two" }), ...poses(4.0015, 6, 300),
    ];
    const { recording, decoder } = await madeRecording(messages);
    const late = recording.chunks.findIndex(({ topics }) => topics.has("/event"));
    expect(recording.chunks[late]!.end).toBeGreaterThan(recording.chunks[late + 1]!.begin);
    const lookup = new Lookup(recording, new ChunkCache(recording, decoder));
    expect(fromBinary(GeometrySchema, (await lookup.last("/geometry", 4.002))!.value).revision).toBe(2);
    expect((await lookup.last("/setup", 4.002))!.value.device).toBe("two");
    expect((await lookup.last("/setup", 4.0005))!.value.device).toBe("one");
    expect(fromBinary(TickSchema, (await lookup.last("/pose", 4.002))!.value).tick).toBe(300n);
    await lookup.load(0, 6);
    expect(lookup.next(["/geometry"], 3)).toBeCloseTo(4.001, 6);
    expect(lookup.poses(3.99, 4.002).map(({ value }) => fromBinary(TickSchema, value).tick)).toEqual([300n]);
  });

  it("has all poses of a stretch, each once and in order", async () => {
    const { lookup, times } = await twoStations();
    await lookup.load(3.5, 9.5);
    const found = lookup.poses(3.5, 9.5);
    expect(found.length).toBe(times.filter((time) => time > 3.5 && time <= 9.5).length);
    expect(found.every(({ time }, i) => i === 0 || time > found[i - 1]!.time)).toBe(true);
    expect(fromBinary(TickSchema, found.at(-1)!.value).time).toBeCloseTo(1000 + found.at(-1)!.time, 6);
  });
});
