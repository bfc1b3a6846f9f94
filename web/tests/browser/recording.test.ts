// SPDX-License-Identifier: Apache-2.0
// The recording of a run: what the page says of it, and whether an independent reader accepts it, also after the program was killed.
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { McapIndexedReader, McapStreamReader, type McapTypes } from "@mcap/core";
import { parse as parseDefinition } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { fromBinary } from "@bufbuild/protobuf";
import { decompress } from "fzstd";
import { describe, expect, it } from "vitest";
import { StepSchema } from "../../src/gen/phalanx/recording_pb";
import { TickSchema } from "../../src/gen/phalanx/tick_pb";
import { strings } from "../../src/strings";
import { programPath } from "./support/program";
import { stage, unseen } from "./support/stage";

const play = stage();
const decompressHandlers: McapTypes.DecompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };

const recordings = (folder: string) => readdirSync(join(folder, "out/recordings")).map((name) => join(folder, "out/recordings", name));

/// All messages by topic, read from the beginning to the end, with all checksums.
function streamed(file: string): Map<string, number> {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(readFileSync(file));
  const topics = new Map<number, string>();
  const counts = new Map<string, number>();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Channel") topics.set(record.id, record.topic);
    if (record.type !== "Message") continue;
    const topic = topics.get(record.channelId)!;
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
  }
  expect(reader.done()).toBe(true);
  return counts;
}

/// A reader by the index at the file's end.
function byIndexOf(file: string): Promise<McapIndexedReader> {
  const bytes = readFileSync(file);
  const readable = {
    size: () => Promise.resolve(BigInt(bytes.length)),
    read: (offset: bigint, size: bigint) => Promise.resolve(new Uint8Array(bytes.subarray(Number(offset), Number(offset + size)))),
  };
  return McapIndexedReader.Initialize({ readable, decompressHandlers });
}

/// The same through the index at its end.
async function indexed(file: string): Promise<{ counts: Map<string, number>; reader: McapIndexedReader }> {
  const reader = await byIndexOf(file);
  const counts = new Map<string, number>();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const topic = reader.channelsById.get(message.channelId)!.topic;
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
  }
  return { counts, reader };
}

interface Xyz {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}
/// What the messages of the bag hold, as far as it is compared.
interface RosMessage {
  readonly header: { readonly stamp: { readonly sec: number; readonly nsec: number }; readonly frame_id: string };
  readonly name: readonly string[];
  readonly position: Float64Array;
  readonly velocity: Float64Array;
  readonly effort: Float64Array;
  readonly wrench: { readonly force: Xyz; readonly torque: Xyz };
  readonly transforms: readonly {
    readonly child_frame_id: string;
    readonly transform: { readonly translation: Xyz; readonly rotation: Xyz & { readonly w: number } };
  }[];
}

const size = ({ x, y, z }: Xyz) => Math.hypot(x, y, z);

/// Compares a ROS 2 bag with the recording that it was made of.
async function compareBag(bag: string, file: string): Promise<void> {
  const torques = new Map<bigint, readonly number[]>();
  const ticks = new Map<bigint, ReturnType<typeof tickOf>>();
  const tickOf = (bytes: Uint8Array) => fromBinary(TickSchema, bytes);
  const recording = await byIndexOf(file);
  for await (const { channelId, logTime, data } of recording.readMessages({ topics: ["/step", "/pose"] })) {
    if (recording.channelsById.get(channelId)!.topic === "/pose") ticks.set(logTime, tickOf(data));
    else torques.set(logTime, fromBinary(StepSchema, data).torque);
  }
  const reader = await byIndexOf(join(bag, "recording_0.mcap"));
  expect(reader.header.profile).toBe("ros2");
  const decoders = new Map([...reader.channelsById.values()].map((channel) => {
    const schema = reader.schemasById.get(channel.schemaId)!;
    expect([schema.encoding, channel.messageEncoding]).toEqual(["ros2msg", "cdr"]);
    return [channel.id, new MessageReader(parseDefinition(new TextDecoder().decode(schema.data), { ros2: true }))];
  }));
  const wrenches = [...reader.channelsById.values()].map((channel) => channel.topic).filter((topic) => topic.startsWith("/wrench/"));
  const counts = new Map<string, number>();
  let felt = 0;
  for await (const { channelId, logTime, data } of reader.readMessages({ validateCrcs: true })) {
    const topic = reader.channelsById.get(channelId)!.topic;
    const message = decoders.get(channelId)!.readMessage<RosMessage>(data);
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
    if (message.header) expect(BigInt(message.header.stamp.sec) * 1_000_000_000n + BigInt(message.header.stamp.nsec)).toBe(logTime);
    if (topic === "/joint_states") {
      expect(message.name[4]).toBe("index_mcp_flexion");
      expect([message.position.length, message.velocity.length]).toEqual([20, 0]);
      const torque = torques.get(logTime)!;
      expect([...message.effort]).toEqual(torque.length > 0 ? [...torque] : Array(20).fill(0));
    } else if (topic === "/shown/joint_states") {
      expect([...message.position]).toEqual([...ticks.get(logTime)!.gdpAngle]);
    } else if (topic === "/tf") {
      const pose = ticks.get(logTime)!.gdpPose;
      message.transforms.forEach(({ child_frame_id, transform }, segment) => {
        expect(transform.translation.x, child_frame_id).toBe(pose[7 * segment]);
        expect(transform.rotation.w ** 2 + size(transform.rotation) ** 2).toBeCloseTo(1, 9);
      });
    } else if (topic.startsWith("/wrench/")) {
      expect(`/wrench/${message.header.frame_id}`).toBe(topic);
      const segment = wrenches.indexOf(topic);
      const tick = ticks.get(logTime)!;
      const force = tick.factor * (tick.contact.find((contact) => contact.segment === segment)?.force ?? 0);
      expect(size(message.wrench.force)).toBeCloseTo(force, 5);
      if (force > 0.1) ++felt;
    }
  }
  expect(counts.get("/tf")).toBe(ticks.size);
  expect(counts.get("/wrench/index_finger_phalanx_distal")).toBe(ticks.size);
  expect(felt, "forces that are compared").toBeGreaterThan(0);
  const said = readFileSync(join(bag, "metadata.yaml"), "utf8");
  expect(said).toContain(`  message_count: ${[...counts.values()].reduce((sum, count) => sum + count, 0)}\n`);
}

describe("the recording", () => {
  it("is shown in the page, and an independent reader accepts it", async () => {
    const station = await play.ownStation(["first_touch"]);
    const page = await play.open(station.url, unseen);
    await page.untilRunning();
    await page.untilState("a recording with something in it", (state) => (state.recording?.bytes ?? 0n) > 400_000n);
    expect(page.stream.state!.recording!.file).toMatch(/^out\/recordings\/.*\.mcap$/);
    expect(page.stream.state!.recording!.freeBytes).toBeGreaterThan(0n);
    expect(await page.page.locator(".chip-recording").textContent()).toBe(strings.recording.on);
    await page.stopButton.click();
    await page.untilStopped();
    await station.program.end();
    const [file] = recordings(station.folder);
    const counts = streamed(file!);
    expect(counts.get("/setup")).toBe(1);
    expect(counts.get("/geometry")).toBe(1);
    expect(counts.get("/step")).toBeGreaterThan(100);
    expect(counts.get("/pose")).toBeGreaterThan(10);
    expect(counts.get("/event"), "the stop").toBeGreaterThan(0);
    const { counts: byIndex, reader } = await indexed(file!);
    expect(byIndex).toEqual(counts);
    expect(Number(reader.statistics!.messageCount)).toBe([...counts.values()].reduce((sum, count) => sum + count, 0));
    expect([...reader.schemasById.values()].map((schema) => schema.encoding)).toEqual(Array(9).fill("protobuf"));
    const said = execFileSync(programPath(), ["replay", file!], { encoding: "utf8" });
    expect(said).toContain("every force, angle and command has the same bits");
    const bag = join(station.folder, "bag");
    execFileSync(programPath(), ["session", "export", file!, "--format", "ros2", "--out", bag, "--quiet"]);
    await compareBag(bag, file!);
  });

  it("of a killed program is repaired, and is accepted then", async () => {
    const station = await play.ownStation(["first_touch"]);
    const page = await play.open(station.url, unseen);
    await page.untilState("a recording with something in it", (state) => (state.recording?.bytes ?? 0n) > 400_000n);
    await station.program.kill();
    const [file] = recordings(station.folder);
    const said = execFileSync(programPath(), ["session", "repair", file!], { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
    expect(said).toBe("");
    expect(existsSync(`${file}.torn`)).toBe(true);
    expect((await indexed(file!)).counts).toEqual(streamed(file!));
    expect(execFileSync(programPath(), ["replay", file!], { encoding: "utf8" })).toContain("0 different");

    // The same file, cut anywhere behind its beginning.
    const whole = readFileSync(file!);
    let seed = 22;
    for (let i = 0; i < 25; ++i) {
      seed = (seed * 48271) % 2147483647;
      const length = 60_000 + (seed % (whole.length - 60_000));
      const cut = join(station.folder, "cut.mcap");
      writeFileSync(cut, whole.subarray(0, length));
      execFileSync(programPath(), ["session", "repair", cut], { stdio: "ignore" });
      const { counts } = await indexed(cut);
      expect(counts, `case ${i}, length ${length}`).toEqual(streamed(cut));
    }
  });
});
