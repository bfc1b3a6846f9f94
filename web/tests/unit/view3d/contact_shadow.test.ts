// SPDX-License-Identifier: Apache-2.0
import { Box3, BoxGeometry, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { ContactShadow } from "../../../src/view3d/contact_shadow";
import { squareAround, undersideOf } from "../../../src/view3d/underside";

const square = squareAround(new Box3(new Vector3(-0.1, -0.1, 0), new Vector3(0.1, 0.1, 0.1)));
const finger = (x: number, z: number) => ({ from: [x, -0.02, z] as const, to: [x, 0.02, z] as const, radius: 0.008 });

describe("the contact shadow", () => {
  it("lies under the object, darkest where it stands, and not beside it", () => {
    const cube = new BoxGeometry(0.06, 0.06, 0.06);
    const underside = undersideOf(cube.getAttribute("position").array, cube.getIndex()!.array);
    const darkness = [0, 0.05, 0.2].map((lift) => {
      const shadow = new ContactShadow();
      shadow.lay(underside.square, -0.03 - lift, underside.lowest);
      expect(shadow.darknessAt(0.2, 0.2)).toBe(0);
      return shadow.darknessAt(0, 0);
    });
    expect(darkness[0]).toBeGreaterThan(0.5);
    expect(darkness[1]).toBeLessThan(darkness[0]!);
    expect(darkness[2]).toBeLessThan(0.02);
  });
  it("lies under a finger, softer and weaker the higher it is, and goes with it", () => {
    const shadow = new ContactShadow();
    shadow.lay(square, 0, null);
    expect(shadow.darknessAt(0.05, 0)).toBe(0);
    shadow.cast([finger(0.05, 0.01)]);
    const near = shadow.darknessAt(0.05, 0);
    expect(near).toBeGreaterThan(0.2);
    expect(shadow.darknessAt(-0.05, 0)).toBe(0);
    shadow.cast([finger(0.05, 0.06)]);
    expect(shadow.darknessAt(0.05, 0)).toBeLessThan(near);
    shadow.cast([finger(-0.05, 0.01)]);
    expect(shadow.darknessAt(0.05, 0)).toBe(0);
    expect(shadow.darknessAt(-0.05, 0)).toBeCloseTo(near, 1);
  });
  it("is nowhere outside its square", () => {
    const shadow = new ContactShadow();
    shadow.lay(square, 0, null);
    shadow.cast([finger(3, 0.01), finger(-3, 0.01)]);
    expect(shadow.texels.every((texel) => texel === 0)).toBe(true);
    expect(shadow.darknessAt(3, 0)).toBe(0);
  });
});

it("the underside of an object is its lowest point above each place, however large its triangles are", () => {
  const cube = new BoxGeometry(0.3, 0.3, 0.1).translate(1, 0, 0.25);
  const { square: around, lowest } = undersideOf(cube.getAttribute("position").array, cube.getIndex()!.array);
  expect(around.x + around.edge / 2).toBeCloseTo(1, 6);
  const under = lowest.filter((z) => z !== Infinity);
  expect(under.length / lowest.length).toBeCloseTo((0.3 / around.edge) ** 2, 1);
  for (const z of under) expect(z).toBeCloseTo(0.2, 6);
});
