// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { fist, WantedAngles } from "../../../src/panels/joint_sliders";

describe("sliders of joints", () => {
  it("send only the joints of this page: the station's values may be old", () => {
    let now = 0;
    const wanted = new WantedAngles(() => now);
    wanted.want(3, 0.9);
    wanted.want(4, 0.2);
    wanted.sent(new Set([4]));
    now += 60_000;
    expect(wanted.toSend()).toEqual(Array.from({ length: 20 }, (_, joint) => (joint === 4 ? 0.2 : NaN)));
  });

  it("show for joints that are not held what the station says", () => {
    let now = 0;
    const wanted = new WantedAngles(() => now);
    const station = new Array<number>(20).fill(0.1);
    wanted.want(3, 0.9);
    expect(wanted.angles(station)[3]).toBe(0.9);
    station[5] = 0.7;
    expect(wanted.angles(station)[5]).toBe(0.7);
    wanted.sent(new Set([3]));
    now += 60_000;
    expect(wanted.angles(station)[3], "still held").toBe(0.9);
    wanted.sent(new Set());
    now += 500;
    expect(wanted.angles(station)[3], "the station may not have said it yet").toBe(0.9);
    now += 1000;
    expect(wanted.angles(station)).toEqual(station);
    wanted.want(3, 0.9);
    wanted.forget();
    expect(wanted.angles(station)).toEqual(station);
  });

  it("a fist flexes them and does not spread", () => {
    const open = new Array<number>(20).fill(0.1);
    const max = new Array<number>(20).fill(1.1);
    const made = fist(open, max);
    expect(made[0]).toBeCloseTo(0.9, 12);
    expect(made[1]).toBe(0.1);
    expect(made[19]).toBeCloseTo(0.9, 12);
  });
});
