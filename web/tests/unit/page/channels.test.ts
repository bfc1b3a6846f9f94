// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { channels, digitForces, fillRow, type Quantity } from "../../../src/state/channels";

it("what is sent is the factor times the force; a digit's force is the sum of its segments'", () => {
  const contact = [
    { segment: 5, touching: true, force: 2, forceRaw: 3 },
    { segment: 4, touching: true, force: 1, forceRaw: 1 },
    { segment: 15, touching: true, force: 9, forceRaw: 9 },
  ];
  const tick = create(TickSchema, { factor: 0.5, contact });
  expect(digitForces(tick)).toEqual([0, 1.5, 0, 0, 0]);
  const row = new Float64Array(channels.length);
  fillRow(tick, row);
  const of = (quantity: Quantity, part: number) => row[channels.find((one) => one.quantity === quantity && one.part === part)!.index];
  expect(of("force_raw", 5)).toBe(3);
  expect(of("force_sent", 5)).toBe(1);
  expect(of("force_sent", 0)).toBe(0);
  expect(of("torque", 0)).toBeNaN();
});
