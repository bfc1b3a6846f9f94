// SPDX-License-Identifier: Apache-2.0
import { fromBinary } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { Player } from "../../../src/replay/player";
import type { Shapes } from "../../../src/view3d/shapes";
import { change, forceAt, forceOf, gap, geometry, kRate, madeRecording, pose, poses, setup } from "./made_recording";

const kHistorySeconds = 10; // at first
type Message = Parameters<typeof madeRecording>[0][number];
const kFrameMs = 20;
const revisionOf = (shapes: Shapes | undefined) => Number(shapes?.jointName[0] ?? 0);

async function playerOf(messages: readonly Message[]) {
  const { recording, source, decoder } = await madeRecording(messages);
  const made = { shapes: 0 };
  const broken = new Set<number>(); // revisions that cannot be made into shapes
  const player = new Player(recording, decoder, (bytes) => {
    ++made.shapes;
    const { revision } = fromBinary(GeometrySchema, new Uint8Array(bytes));
    return broken.has(revision) ? Promise.reject(new Error("no shapes")) : Promise.resolve({ jointName: [String(revision)] } as unknown as Shapes);
  });
  let now = 0;
  const seen: bigint[] = [];
  player.on(["tick"], () => player.tick && seen.push(player.tick.tick));
  return {
    player, source, made, broken, seen,
    at: async (time: number) => {
      player.seek(time);
      await player.settle();
    },
    /// Frames of the page for so long by its clock; between them, what was asked for arrives.
    run: async (seconds: number) => {
      for (const end = now + 1000 * seconds; now < end; ) {
        player.frame((now += kFrameMs));
        await new Promise((resolve) => setTimeout(resolve));
      }
    },
    rows: () => Array.from(player.history.time(), (time) => time - 1000),
  };
}

const simple = () => playerOf([geometry(0, 1), setup(0.001), ...poses(0.02, 30)]);
const poseTime = (number: number) => 0.02 + (number - 1) / kRate;

describe("a recording that is shown", () => {
  it("shows the pose of the moment, and the curves up to it, wherever one goes", async () => {
    const { player, at, rows } = await simple();
    for (const moment of [15, 3, 29.9, 3.001, 22]) {
      await at(moment);
      const number = Math.floor((moment - 0.02) * kRate + 1e-6) + 1;
      expect(player.tick!.tick, `at ${moment}`).toBe(BigInt(number));
      expect(forceOf(player.tick)).toBeCloseTo(forceAt(poseTime(number)), 5);
      expect(rows().at(-1)).toBeCloseTo(poseTime(number), 6);
      const first = Math.max(0.02, moment - kHistorySeconds);
      expect(rows()[0]! - first).toBeLessThan(1.01 / kRate);
      expect(rows().length).toBe(Math.round((rows().at(-1)! - rows()[0]!) * kRate) + 1);
      expect(player.lost).toBe(false);
      expect(revisionOf(player.geometry)).toBe(1);
    }
  });

  it("begins with its first pose, which comes a moment after its begin", async () => {
    const { player, at } = await simple();
    await at(0);
    expect(player.tick!.tick).toBe(1n);
    expect(player.viewDead).toBe(false);
  });

  it("plays every pose once and in order, at any speed", async () => {
    for (const speed of [1, 4]) {
      const { player, at, run, rows } = await simple();
      await at(5);
      player.playhead.setSpeed(speed);
      player.playhead.play();
      await run(2);
      expect(player.playhead.position).toBeGreaterThan(5 + 1.5 * speed);
      expect(player.playhead.position).toBeLessThan(5 + 2.1 * speed);
      expect(rows().length).toBeGreaterThan(kRate * 5);
      rows().slice(1).forEach((time, i) => expect(time - rows()[i]!).toBeCloseTo(1 / kRate, 6));
      expect(player.playhead.position - rows().at(-1)!).toBeLessThan(1.01 / kRate);
    }
  });

  it("of many moments that are asked for at once shows the last one", async () => {
    const { player, seen } = await simple();
    for (let i = 0; i < 40; ++i) player.seek(i / 2);
    player.seek(12.5);
    await player.settle();
    expect(player.tick!.tick).toBe(BigInt(Math.floor((12.5 - 0.02) * kRate) + 1));
    expect(seen.length).toBeLessThan(10);
  });

  it("goes by single poses, forward and back, and no farther than the ends", async () => {
    const { player, at } = await simple();
    await at(10);
    const number = player.tick!.tick;
    await player.step(1);
    expect(player.tick!.tick).toBe(number + 1n);
    void player.step(-1);
    await player.step(-1);
    expect(player.tick!.tick).toBe(number - 1n);
    await at(0);
    await player.step(-1);
    expect(player.tick!.tick).toBe(1n);
    await at(30);
    const last = player.tick!.tick;
    await player.step(1);
    expect(player.tick!.tick).toBe(last);
  });

  it("goes from the moment that was chosen last, and not back to a step that was asked for before it", async () => {
    const { player, at } = await simple();
    await at(10);
    player.seek(0);
    await player.step(1);
    expect(player.tick!.tick).toBe(2n);
    const step = player.step(1);
    player.seek(20);
    await step;
    await player.settle();
    expect(player.playhead.position).toBe(20);
  });

  it("lets one step wait, not all those that a held key asks for", async () => {
    const { player, at } = await simple();
    await at(10);
    const number = player.tick!.tick;
    let last = Promise.resolve();
    for (let i = 0; i < 50; ++i) last = player.step(1);
    await last;
    expect(player.tick!.tick).toBe(number + 2n);
  });

  it("does not show the hand and the forces of one moment as those of another while that is read", async () => {
    const { player, source, at, run } = await simple();
    await at(2);
    let answer = () => {};
    source.held = new Promise((resolve) => (answer = resolve));
    player.seek(25);
    await run(0.1);
    expect([player.loading, player.viewDead]).toEqual([true, false]); // nothing flickers
    await run(0.4);
    expect([player.loading, player.lost, player.viewDead, player.hole]).toEqual([true, true, true, false]);
    answer();
    await player.settle();
    expect([player.lost, player.viewDead]).toEqual([false, false]);
  });

  it("has no hand where a gap says that steps are missing, however short, and curves as far back as elsewhere", async () => {
    const { player, at, run, rows } = await playerOf([
      geometry(0, 1, 200), setup(0.001), ...poses(0.02, 3), gap(3.2, 600n, 639n, "late"), ...poses(3.2, 4, 400), ...poses(12, 13, 500),
    ]);
    for (const [moment, missing] of [[2.99, false], [3.1, true], [3.19, true], [3.21, false], [3.9, false]] as const) {
      await at(moment);
      expect([player.hole, player.viewDead], `at ${moment}`).toEqual([missing, missing]);
    }
    player.playhead.setSpeed(0.25);
    player.playhead.play();
    await run(30);
    expect(player.playhead.position).toBeGreaterThan(10);
    expect(rows()[0]).toBeLessThan(player.playhead.position - kHistorySeconds + 0.5);
  });

  it("has no object where none is recorded yet, or where it cannot be made into shapes", async () => {
    const { player, at, broken } = await playerOf([setup(0), ...poses(0.02, 3), geometry(3, 1), ...poses(3.01, 6, 200), geometry(6, 2), ...poses(6.01, 9, 400)]);
    broken.add(2);
    const shown = () => [revisionOf(player.geometry), player.viewDead, player.shapesTrouble];
    for (const [moment, is] of [[4, [1, false, false]], [2, [0, true, false]], [4, [1, false, false]], [7, [0, true, true]], [5, [1, false, false]]] as const) {
      await at(moment);
      expect(shown(), `at ${moment}`).toEqual(is);
      expect(player.lost).toBe(false); // forces and angles are those of the moment
    }
  });

  it("opens at the first pose, also where it comes long after the begin", async () => {
    const { player } = await playerOf([setup(0), geometry(0.5, 1), ...poses(3, 5)]);
    await player.seekFirst();
    await player.settle();
    expect([player.playhead.position, player.tick!.tick]).toEqual([3, 1n]);
    const { player: other } = await simple();
    await other.seekFirst();
    await other.settle();
    expect([other.playhead.position, other.tick!.tick]).toEqual([0, 1n]);
  });

  it("has the object and the station of the moment, also when it plays across their change, and makes each shape once", async () => {
    const sliding = { scene: "slide", value: [{ key: "contact.mode", value: '"sliding"' }, { key: "objects.0.kind", value: '"mug"' }, { key: "limits.fingertip_force_n", value: "4" }] };
    const { player, at, run, made } = await playerOf([
      geometry(0, 1), setup(0.001, { deviceName: "one", rendersTorque: true, channel: [{ kind: 0, index: 3 }, { kind: 4, index: 1 }] }), ...poses(0.02, 3),
      geometry(3, 2), change(3.001, sliding), ...poses(3.01, 6, 200),
      geometry(7, 3), setup(7.001, { deviceName: "two", start: { scene: "x" } }), ...poses(7.02, 9),
    ]);
    await at(2);
    expect([revisionOf(player.geometry), player.station!.device, player.slides]).toEqual([1, "one", false]);
    expect(player.sensedJoint).toEqual([3, 4, 6, 7]);
    expect([player.objectKind, player.digitLimit]).toEqual(["", Infinity]);
    player.playhead.play();
    await run(2);
    expect([revisionOf(player.geometry), player.station!.device, player.slides]).toEqual([2, "one", true]);
    expect([player.objectKind, player.digitLimit]).toEqual(["mug", 4]);
    await run(4.5);
    expect([revisionOf(player.geometry), player.station!.device, player.slides, player.rendersTorque]).toEqual([3, "two", false, false]);
    await at(1);
    expect([revisionOf(player.geometry), player.station!.device]).toEqual([1, "one"]);
    expect(made.shapes).toBe(3);
  });

  it("shows no hand as that of a moment without steps", async () => {
    const { player, at, run, rows } = await playerOf([geometry(0, 1), setup(0.001), ...poses(0.02, 3), ...poses(8, 10, 400)]);
    await at(2);
    expect([player.hole, player.viewDead]).toEqual([false, false]);
    await at(5);
    expect([player.hole, player.viewDead]).toEqual([true, true]);
    expect(rows().at(-1)).toBeCloseTo(5, 6); // the curves end 2 s before
    expect(player.history.channel(0).at(-1)).toBeNaN();
    expect(rows().at(-2)).toBeLessThan(3);
    await at(9);
    expect([player.hole, player.viewDead]).toEqual([false, false]);
    await at(2);
    player.playhead.play();
    await run(3);
    expect([player.hole, player.viewDead]).toEqual([true, true]);
    expect(player.history.channel(0).at(-1)).toBeNaN();
    await run(4);
    expect([player.hole, player.viewDead]).toEqual([false, false]);
    expect(rows()[0]).toBeLessThan(3); // what was before is kept
  });

  it("shows a step that was not measured as such", async () => {
    const kSampleStale = 1 << 12;
    const { player, at } = await playerOf([geometry(0, 1), setup(0.001), ...poses(0.02, 1), pose(1, { tick: 100n, status: kSampleStale })]);
    await at(0.9);
    expect(player.oldCurves).toBe("");
    await at(1);
    expect([player.oldCurves, player.lost, player.hole]).toEqual(["unmeasured", true, false]);
  });

  it("keeps what is there when its source is gone, says so, and goes on when it is back", async () => {
    const { player, source, at, run } = await simple();
    await at(5);
    source.gone = true;
    player.playhead.play();
    await run(1);
    expect(player.trouble).toBeDefined();
    expect(player.playhead.playing).toBe(false);
    expect(player.tick!.tick).toBeGreaterThan(290n);
    expect(player.history.length).toBeGreaterThan(290);
    await at(4);
    expect(player.tick!.tick).toBe(BigInt(Math.floor((4 - 0.02) * kRate) + 1)); // it was read before
    await at(25);
    expect(player.trouble).toBeDefined();
    source.gone = false;
    player.retry();
    await player.settle();
    expect(player.trouble).toBe(undefined);
    expect(player.tick!.tick).toBe(BigInt(Math.floor((25 - 0.02) * kRate) + 1));
  });

  it("without shapes shows all but the hand", async () => {
    const { player, at } = await playerOf([setup(0.001), ...poses(0.02, 3)]);
    await at(2);
    expect(player.geometry).toBe(undefined);
    expect(player.tick).toBeDefined();
    expect(player.history.length).toBeGreaterThan(100);
  });
});
