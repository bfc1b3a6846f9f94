// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { decodeChunk, surveyChunk } from "../../../src/replay/chunk";
import { DecoderError, threadDecoder, type ChunkWorker, type Task } from "../../../src/replay/decoder";
import { event, forceAt, gap, geometry, madeRecording, poses, setup } from "./made_recording";

/// A worker whose answers the test gives.
function fakeWorker(): { worker: ChunkWorker; tasks: Task[] } {
  const tasks: Task[] = [];
  return { tasks, worker: { onmessage: null, onerror: null, postMessage: (task) => tasks.push(task), terminate: () => {} } };
}

const layout = { begin: 0n, topics: new Map(), channels: [] };

it("answers of the thread go to those who asked, in whatever order they come", async () => {
  const { worker, tasks } = fakeWorker();
  const decoder = threadDecoder(layout, () => worker);
  const [first, second] = [decoder.survey(new Uint8Array([1])), decoder.survey(new Uint8Array([2]))];
  const survey = (value: number) => ({ forces: Float64Array.of(value), events: [], gaps: [], stations: [], rates: [] });
  worker.onmessage!({ data: { id: tasks[1]!.id, result: survey(2) } });
  worker.onmessage!({ data: { id: tasks[0]!.id, error: "damaged" } });
  expect((await second).forces[0]).toBe(2);
  await expect(first).rejects.toThrow("damaged");
});

it("tasks of a thread that has failed are refused, not awaited for ever", async () => {
  const { worker } = fakeWorker();
  const decoder = threadDecoder(layout, () => worker);
  const asked = decoder.decode(new Uint8Array([1]));
  worker.onerror!(new Event("error"));
  await expect(asked).rejects.toThrow(DecoderError);
  await expect(decoder.survey(new Uint8Array([2]))).rejects.toThrow(DecoderError); // and what is asked for later
});

const kSettings = [{ key: "objects.0.kind", value: '"mug"' }, { key: "limits.fingertip_force_n", value: "7.5" }];

it("a chunk holds what was written, with times since the begin; its survey has the forces", async () => {
  const { recording, source } = await madeRecording([
    geometry(0, 7), setup(0.001, { deviceName: "beihang", deviceRateHz: 200, start: { scene: "s", value: kSettings, model: { object: { position: new Array<number>(300).fill(1) } } } }),
    ...poses(0.01, 1), event(0.9, "marker", "one", "127.0.0.1"), gap(0.95, 5n, 9n, "late"),
  ]);
  const parts = await Promise.all(recording.chunks.map(({ offset, length }) => source.read(BigInt(offset), BigInt(length))));
  const contents = parts.map((part) => decodeChunk(part, recording.layout));
  expect(contents.flatMap((content) => content.poses.map(({ time }) => time)).length).toBe(60);
  expect(contents.flatMap((content) => content.stations)).toEqual([
    {
      time: 0.001,
      value: {
        scene: "s", slides: false, objectKind: "mug", digitLimit: 7.5, law: "", stabiliser: "", rate: "",
        device: "beihang", rendersTorque: false, simulated: false, sensedJoint: [],
      },
    },
  ]);
  expect(contents.flatMap((content) => content.events)).toEqual([{ time: 0.9, value: { code: "marker", who: "127.0.0.1", text: "one" } }]);
  expect(contents.flatMap((content) => content.gaps)).toEqual([{ time: 0.95, value: { steps: 5, why: "late" } }]);
  const rows = parts.map((part) => surveyChunk(part, recording.layout).forces).flatMap((forces) => [...forces]);
  expect(rows.length).toBe(60 * 6);
  expect(rows[6 * 30 + 2]).toBeCloseTo(forceAt(rows[6 * 30]!), 5); // the index finger
});
