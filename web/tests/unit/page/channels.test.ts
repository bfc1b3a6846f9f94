// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { channels, digitForces, fillRow, followers, kJoints, type Quantity } from "../../../src/state/channels";

it("what is sent is the factor times the force; a digit's force is the length of the sum of its segments'", () => {
  const contact = [
    { segment: 5, touching: true, force: 3, forceRaw: 5, normal: [0, 0, 1] },
    { segment: 4, touching: true, force: 4, forceRaw: 4, normal: [0, -1, 0] },
    { segment: 15, touching: true, force: 9, forceRaw: 9, normal: [1, 0, 0] },
  ];
  const tick = create(TickSchema, { factor: 0.5, contact });
  expect(digitForces(tick)).toEqual([0, 2.5, 0, 0, 0]);
  const row = new Float64Array(channels.length);
  fillRow(tick, row);
  const of = (quantity: Quantity, part: number) => row[channels.find((one) => one.quantity === quantity && one.part === part)!.index];
  expect(of("force_raw", 5)).toBe(5);
  expect(of("force_sent", 5)).toBe(1.5);
  expect(of("force_sent", 0)).toBe(0);
  expect(of("torque", 0)).toBeNaN();
});

it("angles of a step that was not measured are not known", () => {
  const joints = new Array<number>(kJoints).fill(1);
  const row = new Float64Array(channels.length);
  const newest = (quantity: Quantity) => row[channels.find((one) => one.quantity === quantity)!.index];
  for (const [status, known] of [[0, 1], [1 << 12, NaN]] as const) {
    fillRow(create(TickSchema, { status, torque: joints, hcpAngle: joints, gdpAngle: joints }), row);
    expect(newest("angle_measured")).toBe(known);
    expect(newest("angle_shown")).toBe(known);
    expect(newest("torque")).toBe(1);
  }
});

it("a digit of which no joint is measured or moved follows others", () => {
  expect(followers([0, 2, 5, 19])).toEqual([false, false, true, true, false]);
  expect(followers([])).toEqual([true, true, true, true, true]);
});
