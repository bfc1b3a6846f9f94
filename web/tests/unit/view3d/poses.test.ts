// SPDX-License-Identifier: Apache-2.0
import { Matrix4, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { bindInverses, poseMatrices, poseMatrix } from "../../../src/view3d/poses";
import { kSegments } from "../../../src/view3d/segments";

const half = Math.SQRT1_2;
const quarterTurnAboutZ = [1, 2, 3, 0, 0, half, half];

describe("poseMatrix", () => {
  it("turns, then moves: by hand, a quarter turn about z takes x to y", () => {
    const matrix = new Matrix4();
    expect(poseMatrix(quarterTurnAboutZ, 0, matrix)).toBe(true);
    const moved = new Vector3(1, 0, 0).applyMatrix4(matrix);
    expect(moved.x).toBeCloseTo(1, 12);
    expect(moved.y).toBeCloseTo(3, 12);
    expect(moved.z).toBeCloseTo(3, 12);
  });
  it("does not scale with a quaternion that is not quite a unit one", () => {
    const matrix = new Matrix4();
    poseMatrix([0, 0, 0, 0, 0, 0, 1.01], 0, matrix);
    expect(matrix.determinant()).toBeCloseTo(1, 12);
  });
  it("leaves the matrix alone if a number is missing, not finite, or the quaternion is zero", () => {
    for (const bad of [[1, 2, 3], [1, 2, 3, 0, 0, 0, NaN], [1, 2, 3, 0, 0, 0, 0], [Infinity, 0, 0, 0, 0, 0, 1]]) {
      const matrix = new Matrix4();
      expect(poseMatrix(bad, 0, matrix)).toBe(false);
      expect(matrix.equals(new Matrix4())).toBe(true);
    }
  });
});

describe("poseMatrices", () => {
  it("wants all 16", () => {
    const whole = Array.from({ length: kSegments }, () => quarterTurnAboutZ).flat();
    expect(poseMatrices(whole)).toHaveLength(kSegments);
    expect(poseMatrices(whole.slice(0, -1))).toBeNull();
  });
});

describe("bindInverses", () => {
  it("undoes the bind pose: X_BS X_SB = 1", () => {
    const whole = Array.from({ length: kSegments }, () => quarterTurnAboutZ).flat();
    const product = poseMatrices(whole)![5]!.clone().multiply(bindInverses(whole)![5]!);
    new Matrix4().elements.forEach((element, i) => expect(product.elements[i]).toBeCloseTo(element, 12));
  });
});
