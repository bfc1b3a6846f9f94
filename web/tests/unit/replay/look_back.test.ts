// SPDX-License-Identifier: Apache-2.0
import { fromBinary } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { LookBack } from "../../../src/replay/look_back";
import type { Shapes } from "../../../src/view3d/shapes";
import { bytesOf, geometry, kBegin, plainDecoder, pose, poses, setup, sourceOf } from "./made_recording";

type Message = Parameters<typeof bytesOf>[0][number];
const kClock = 1000; // the ticks' clock minus the recording's time, as made_recording writes it [s]
const kUtcOffset = Number(kBegin) / 1e9 - kClock;
const revisionOf = (shapes: Shapes | undefined) => shapes?.jointName[0];

/// A recording that grows: its length is the number of its messages.
async function growing(messages: readonly Message[]) {
  const made = { opened: [] as bigint[], shapes: 0, decoders: 0, closed: 0 };
  const known = new Map<bigint, Uint8Array>();
  for (let count = 1; count <= messages.length; ++count) known.set(BigInt(count), await bytesOf(messages.slice(0, count)));
  const look = new LookBack(
    (until) => {
      made.opened.push(until);
      return sourceOf(known.get(until)!);
    },
    (bytes) => {
      ++made.shapes;
      return Promise.resolve({ jointName: [String(fromBinary(GeometrySchema, new Uint8Array(bytes)).revision)] } as unknown as Shapes);
    },
    ({ layout }) => {
      ++made.decoders;
      return { ...plainDecoder(layout), close: () => void ++made.closed };
    },
  );
  const at = async (time: number, written: number, utcOffset = kUtcOffset) => look.at(kClock + time, utcOffset, BigInt(written));
  return { look, at, made };
}

const beginning = [geometry(0, 1), setup(0.001), ...poses(0.02, 1)];
const session = [...beginning, geometry(1.1, 2), ...poses(1.12, 2, 100)];

it("the hand of a moment is the nearest recorded one, with the shapes of that moment", async () => {
  const { at, made } = await growing(session);
  const early = await at(0.52, session.length);
  expect(Math.abs(early!.tick.time - kClock - 0.52)).toBeLessThan(0.6 / 60);
  expect(revisionOf(early!.geometry)).toBe("1");
  expect((await at(1.5, session.length))!.tick.tick).toBe(123n);
  expect(revisionOf((await at(1.5, session.length))!.geometry)).toBe("2");
  expect(made.opened).toEqual([BigInt(session.length)]); // once
  expect(made.shapes).toBe(2);
});

it("a moment that was not on the disk yet is read when it is; the index is read again for nothing else", async () => {
  const { at, made } = await growing(session);
  expect((await at(0.5, beginning.length))!.tick.tick).toBe(30n);
  expect(await at(1.6, beginning.length)).toBeUndefined();
  expect(made.opened).toHaveLength(1);
  expect((await at(1.6, session.length))!.tick.tick).toBe(129n);
  expect(made.opened).toEqual([BigInt(beginning.length), BigInt(session.length)]);
  expect(made.closed).toBe(1);
  expect((await at(0.5, session.length))!.tick.tick).toBe(30n);
  expect(made.opened).toHaveLength(2);
});

it("a moment without steps has no hand, also between steps", async () => {
  const messages = [geometry(0, 1), setup(0.001), ...poses(0.02, 1), ...poses(5, 6, 500)];
  const { at } = await growing(messages);
  expect(await at(3, messages.length)).toBeUndefined();
  expect(await at(-2, messages.length)).toBeUndefined();
  expect(await at(60, messages.length)).toBeUndefined();
  expect((await at(5.5, messages.length))!.tick.tick).toBe(530n);
});

it("the computer's clock may have been set since the recording began", async () => {
  const { at } = await growing(session);
  expect((await at(1.5, session.length, kUtcOffset - 0.4))!.tick.tick).toBe(123n);
  const late = await growing(session);
  expect((await late.at(0.3, session.length, kUtcOffset - 3600))!.tick.tick).toBe(18n);
});

it("what is opened when the reading has ended keeps no thread", async () => {
  const { look, at, made } = await growing(session);
  const reading = at(0.5, session.length);
  look.close();
  expect(await reading).toBeUndefined();
  expect(made.decoders).toBe(0);
});

it("a recording without shapes has a hand without them", async () => {
  const messages = [setup(0), pose(0.1, { tick: 7n })];
  const { at } = await growing(messages);
  const hand = await at(0.1, 2);
  expect(hand!.tick.tick).toBe(7n);
  expect(hand!.geometry).toBeUndefined();
});
