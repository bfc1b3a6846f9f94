// SPDX-License-Identifier: Apache-2.0
// What programs of others find in a recording: its ROS 2 bag, and its 3D scene in Foxglove's schemas.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { createFileRegistry, fromBinary, type DescMessage, type Message } from "@bufbuild/protobuf";
import { FileDescriptorSetSchema } from "@bufbuild/protobuf/wkt";
import { parse as parseDefinition } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { foxgloveMessageSchemas } from "@foxglove/schemas/internal";
import { Quaternion, Vector3 } from "three";
import { expect } from "vitest";
import { StepSchema } from "../../../src/gen/phalanx/recording_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { byIndexOf } from "./mcap";

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
export async function compareBag(bag: string, file: string): Promise<void> {
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
      const contact = tick.contact.find((one) => one.segment === segment);
      const force = tick.factor * (contact?.force ?? 0);
      expect(size(message.wrench.force)).toBeCloseTo(force, 5);
      if (!contact || force < 0.1) continue;
      // In the world frame, the force has the contact's direction, and its moment is that of the contact's point.
      const [x, y, z, qx, qy, qz, qw] = tick.gdpPose.slice(7 * segment, 7 * segment + 7) as [number, number, number, number, number, number, number];
      const q = new Quaternion(qx, qy, qz, qw);
      const asked = new Vector3(...(contact.normal as [number, number, number])).multiplyScalar(force);
      const moment = new Vector3(...(contact.point as [number, number, number])).sub(new Vector3(x, y, z)).cross(asked);
      const inWorld = ({ x: a, y: b, z: c }: Xyz) => new Vector3(a, b, c).applyQuaternion(q);
      expect(inWorld(message.wrench.force).distanceTo(asked)).toBeLessThan(1e-5);
      expect(inWorld(message.wrench.torque).distanceTo(moment)).toBeLessThan(1e-6);
      ++felt;
    }
  }
  expect(counts.get("/tf")).toBe(ticks.size);
  expect(counts.get("/wrench/index_finger_phalanx_distal")).toBe(ticks.size);
  expect(felt, "forces that are compared").toBeGreaterThan(0);
  const said = readFileSync(join(bag, "metadata.yaml"), "utf8");
  expect(said).toContain(`  message_count: ${[...counts.values()].reduce((sum, count) => sum + count, 0)}\n`);
}

interface Frame {
  readonly childFrameId: string;
  readonly translation: Xyz;
}
interface Entity {
  readonly id: string;
  readonly frameId: string;
  readonly arrows: readonly { readonly shaftLength: number }[];
  readonly triangles: readonly { readonly points: readonly Xyz[]; readonly indices: readonly number[] }[];
}

/// Expects that a message of the recording has the fields and numbers that Foxglove's own description states.
function expectFields(message: DescMessage, name: keyof typeof foxgloveMessageSchemas): void {
  const stated = foxgloveMessageSchemas[name].fields.map((field, i) => [field.protobufFieldNumber ?? i + 1, field.name]);
  expect(message.fields.map((field) => [field.number, field.name]), name).toEqual(stated);
}

/// Compares the 3D scene of a recording with its poses, forces and meshes.
export async function compareScene(file: string): Promise<void> {
  const reader = await byIndexOf(file);
  const decode = new Map<number, (bytes: Uint8Array) => Message>();
  const described = new Set<string>();
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId)!;
    const registry = createFileRegistry(fromBinary(FileDescriptorSetSchema, schema.data));
    decode.set(channel.id, (bytes) => fromBinary(registry.getMessage(schema.name)!, bytes));
    if (!channel.topic.startsWith("/foxglove/")) continue;
    for (const type of registry)
      if (type.kind === "message" && type.file.proto.package === "foxglove") {
        expectFields(type, type.name as keyof typeof foxgloveMessageSchemas);
        described.add(type.typeName);
      }
  }
  const ticks = new Map<bigint, { readonly gdpPose: readonly number[]; readonly factor: number; readonly contact: readonly { readonly force: number }[] }>();
  expect([...described]).toEqual(expect.arrayContaining(["foxglove.FrameTransforms", "foxglove.SceneUpdate", "foxglove.TriangleListPrimitive"]));
  let frames = 0;
  let meshes = 0;
  let arrows = 0;
  for await (const { channelId, logTime, data } of reader.readMessages({ topics: ["/pose", "/foxglove/frames", "/foxglove/meshes", "/foxglove/forces"] })) {
    const topic = reader.channelsById.get(channelId)!.topic;
    const message = decode.get(channelId)!(data);
    const { transforms, entities } = message as unknown as { transforms: readonly Frame[]; entities: readonly Entity[] };
    const tick = ticks.get(logTime);
    if (topic === "/pose") ticks.set(logTime, message as never);
    if (topic === "/foxglove/frames") {
      transforms.forEach(({ translation }, segment) => expect(Math.fround(translation.x)).toBe(tick!.gdpPose[7 * segment]));
      expect(transforms.length).toBe(16);
      ++frames;
    }
    if (topic === "/foxglove/meshes") {
      expect(entities.map(({ id, frameId }) => [id, frameId])).toContainEqual(["index-finger-phalanx-distal", "index-finger-phalanx-distal"]);
      for (const { id, triangles } of entities)
        for (const { points, indices } of triangles) expect(Math.max(...indices), id).toBe(points.length - 1);
      ++meshes;
    }
    if (topic === "/foxglove/forces") {
      const shown = entities[0]!.arrows.map(({ shaftLength }) => 100 * shaftLength);
      const asked = tick!.contact.map(({ force }) => tick!.factor * force).filter((force) => force >= 0.01);
      expect(shown.length).toBe(asked.length);
      shown.forEach((force, i) => expect(force).toBeCloseTo(asked[i]!, 5));
      arrows += shown.length;
    }
  }
  expect([frames, meshes]).toEqual([ticks.size, 1]);
  expect(arrows, "forces that are compared").toBeGreaterThan(0);
}
