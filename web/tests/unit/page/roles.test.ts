// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { HandSource, StateSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { mayCalibrate, mayChange, mayTake, roleOf } from "../../../src/state/roles";

const welcome = create(WelcomeSchema, { page: 3, mayOperate: true });
const watcher = create(WelcomeSchema, { page: 3, mayOperate: false });
const state = (operatorPage: number) => create(StateSchema, { operatorPage });

describe("role", () => {
  it("is this page's only while it is connected and operates", () => {
    expect(roleOf(true, welcome, state(3))).toBe("mine");
    expect(roleOf(false, welcome, state(3))).toBe("offline");
    expect(roleOf(true, welcome, undefined)).toBe("offline");
    expect(roleOf(true, welcome, state(0))).toBe("nobody");
    expect(roleOf(true, welcome, state(1))).toBe("other");
    expect(roleOf(true, watcher, state(0))).toBe("watch_only");
  });

  it("only who operates changes; who may operate may take over", () => {
    const roles = ["mine", "offline", "watch_only", "other", "nobody"] as const;
    expect(roles.map(mayChange)).toEqual([true, false, false, false, false]);
    expect(roles.map(mayTake)).toEqual([false, false, false, true, true]);
  });

  it("a calibration needs a device on a wire", () => {
    const wire = create(StateSchema, { source: HandSource.HAND_DEVICE, deviceSimulated: false });
    expect(mayCalibrate("mine", wire)).toBe(true);
    expect(mayCalibrate("other", wire)).toBe(false);
    expect(mayCalibrate("mine", create(StateSchema, { ...wire, deviceSimulated: true }))).toBe(true);
    expect(mayCalibrate("mine", create(StateSchema, { deviceSimulated: true, source: HandSource.HAND_PATIENT }))).toBe(false);
    expect(mayCalibrate("mine", create(StateSchema, { ...wire, source: HandSource.HAND_SLIDERS }))).toBe(false);
    expect(mayCalibrate("mine", undefined)).toBe(false);
  });
});
