// SPDX-License-Identifier: Apache-2.0
import { Vector3 } from "three";
import { expect, it } from "vitest";
import { MotionExtent } from "../../../src/view3d/motion_extent";

const at = (x: number) => [new Vector3(x, 0, 0), new Vector3(x + 0.1, 0, 0.02)];
const reach = (extent: MotionExtent) => [Math.min(...extent.points().map(({ x }) => x)), Math.max(...extent.points().map(({ x }) => x))];

it("the extent of a motion holds all its phases of the last seconds, and no older ones", () => {
  const extent = new MotionExtent();
  expect(extent.points()).toEqual([]);
  extent.add([], 0);
  extent.add(at(0), 1);
  extent.add(at(0.5), 2);
  expect(reach(extent)).toEqual([0, 0.6]);
  for (let time = 3; time < 30; ++time) extent.add(at(0.5), time);
  expect(reach(extent)).toEqual([0.5, 0.6]);
  extent.forget();
  expect(extent.points()).toEqual([]);
});

it("a hand that goes to and fro stays in it", () => {
  const extent = new MotionExtent();
  for (let i = 0; i < 200; ++i) {
    extent.add(at(0.2 * Math.sin(i / 5)), 0.1 * i);
    if (i > 100) {
      expect(reach(extent)[0]).toBeLessThan(-0.18);
      expect(reach(extent)[1]).toBeGreaterThan(0.28);
    }
  }
});
