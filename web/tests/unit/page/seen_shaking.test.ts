// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { StateSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { SeenShaking } from "../../../src/state/seen_shaking";

const state = (method: string, deviceSerial = "A") =>
  create(StateSchema, { deviceSerial, scene: "first_touch", value: [{ key: "stabiliser.method", value: method }] });
const tick = (stiffness: number, oscillating: boolean) => create(TickSchema, { stiffness, contact: [{ touching: true, oscillating }] });

it("keeps the least stiffness at which a force oscillated, apart for each device and its settings", () => {
  const seen = new SeenShaking();
  const none = state('"none"');
  expect(seen.from(none, undefined)).toBeNaN();
  seen.feed(tick(500, false), none, undefined);
  expect(seen.from(none, undefined)).toBeNaN();
  seen.feed(tick(2200, true), none, undefined);
  seen.feed(tick(1800, true), none, undefined);
  seen.feed(tick(3000, true), none, undefined);
  expect(seen.from(none, undefined)).toBeCloseTo(1.8, 9);
  expect(seen.from(state('"smoothing"'), undefined)).toBeNaN();
  expect(seen.from(state('"none"', "B"), undefined)).toBeNaN();
  expect(seen.from(undefined, undefined)).toBeNaN();
});
