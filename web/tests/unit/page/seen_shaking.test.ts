// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { StateSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { SeenShaking } from "../../../src/state/seen_shaking";

const state = (method: string, deviceSerial = "A", others: readonly { key: string; value: string }[] = []) =>
  create(StateSchema, { deviceSerial, scene: "first_touch", value: [{ key: "stabiliser.method", value: method }, ...others] });

function observed() {
  const seen = new SeenShaking();
  let time = 100;
  /// So many seconds of ticks at 60 Hz.
  const run = (seconds: number, stiffness: number, oscillating: boolean, known: ReturnType<typeof state>) => {
    for (let i = 0; i < 60 * seconds; ++i) seen.feed(create(TickSchema, { time: (time += 1 / 60), stiffness, contact: [{ touching: true, oscillating }] }), known);
  };
  return { seen, run };
}

it("keeps the least stiffness at which a force oscillated, apart for each device and its settings", () => {
  const { seen, run } = observed();
  const none = state('"none"');
  expect(seen.from(none)).toBeNaN();
  run(4, 500, false, none);
  expect(seen.from(none)).toBeNaN();
  for (const stiffness of [2200, 1800, 3000]) run(4, stiffness, true, none);
  expect(seen.from(none)).toBeCloseTo(1.8, 9);
  expect(seen.from(state('"smoothing"'))).toBeNaN();
  expect(seen.from(state('"none"', "B"))).toBeNaN();
  expect(seen.from(state('"none"', "A", [{ key: "force.damping_ns_per_m", value: "2" }]))).toBeNaN();
  expect(seen.from(state('"none"', "A", [{ key: "motion.tremor_deg", value: "2" }, { key: "force.stiffness_n_per_mm", value: "1" }]))).toBeCloseTo(1.8, 9);
  expect(seen.from(undefined)).toBeNaN();
});

it("a verdict that outlasts a change is not filed under what came after it, nor a change under what came before", () => {
  const { seen, run } = observed();
  const none = state('"none"');
  const smoothing = state('"smoothing"');
  run(4, 2200, true, none);
  run(1.2, 2200, true, smoothing); // smoothing is on: the verdict is held for a while
  run(5, 2200, false, smoothing);
  expect(seen.from(smoothing)).toBeNaN();
  run(0.5, 2200, true, smoothing); // it is off again and shakes, and State still says on
  run(4, 2200, true, none);
  expect(seen.from(smoothing)).toBeNaN();
  for (let stiffness = 2100; stiffness >= 300; stiffness -= 100) run(0.2, stiffness, true, none); // the slider is dragged while it shakes
  run(1, 300, true, none);
  run(4, 300, false, none);
  expect(seen.from(none)).toBeCloseTo(2.2, 9);
});

it("begins anew where the station's clock does", () => {
  const { seen, run } = observed();
  const none = state('"none"');
  run(2, 900, true, none);
  seen.feed(create(TickSchema, { time: 1, stiffness: 900, contact: [{ oscillating: true }] }), none);
  expect(seen.from(none)).toBeNaN();
});
