// SPDX-License-Identifier: Apache-2.0
import { BoxGeometry, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { upAxes } from "../../../src/state/up_axis";
import { strings } from "../../../src/strings";
import { AxisCross } from "../../../src/view3d/axis_cross";
import { PreviewScene, rotationTo } from "../../../src/view3d/preview_scene";

function slab(x: number, y: number, z: number): PreviewScene {
  const box = new BoxGeometry(x, y, z);
  return new PreviewScene({ position: Float32Array.from(box.getAttribute("position").array), index: Uint32Array.from(box.getIndex()!.array) });
}

function expectExtent(scene: PreviewScene, extent: readonly number[]): void {
  extent.forEach((metres, axis) => expect(scene.extent[axis], `axis ${axis}`).toBeCloseTo(metres, 6));
}

describe("the preview of a mesh", () => {
  it("turns the chosen axis of the file up, and is no mirror image", () => {
    upAxes.forEach((axis, i) => {
      const turned = new Vector3().setComponent(i, 1).applyMatrix4(rotationTo(axis));
      expect(turned.distanceTo(new Vector3(0, 0, 1)), axis).toBeLessThan(1e-12);
      expect(rotationTo(axis).determinant()).toBeCloseTo(1, 12);
    });
  });

  it("stands as the choice says, whatever was chosen before", () => {
    const scene = slab(0.03, 0.04, 0.05);
    expectExtent(scene, [0.03, 0.04, 0.05]);
    scene.setUp("y");
    expectExtent(scene, [0.03, 0.05, 0.04]);
    scene.setUp("x");
    expectExtent(scene, [0.05, 0.04, 0.03]);
    scene.setUp("z");
    expectExtent(scene, [0.03, 0.04, 0.05]);
    scene.release();
  });

  it("has a bar of a palm's breadth before it on the table, a short one before a small mesh", () => {
    for (const [size, bar] of [[0.09, 0.1], [0.4, 0.1], [0.012, 0.01]] as const) {
      const scene = slab(size, size, size / 2);
      expect(scene.barLength).toBe(bar);
      scene.setUp("y");
      expect(scene.barAt.y, "before it").toBeLessThan(-size / 4);
      expect(scene.barAt.z, "at its foot").toBeCloseTo(-size / 2, 2);
      expect(scene.corners()).toHaveLength(10);
      scene.release();
    }
  });
});

it("the cross of axes has the letters where the axes are in the picture, and marks the one that is up", () => {
  const cross = new AxisCross();
  const camera = new PerspectiveCamera();
  camera.up.set(0, 0, 1);
  camera.position.set(0, -1, 0); // looks along y: x to the right, z up
  camera.lookAt(0, 0, 0);
  cross.show(camera, "y");
  const letter = (text: string) => [...cross.element.querySelectorAll("text")].find((one) => one.textContent === text)!;
  const place = (text: string) => ["x", "y"].map((name) => Number(letter(text).getAttribute(name)));
  const up = strings.object.upward(strings.object.axes.y);
  expect(place(up)[1]).toBeLessThan(-20);
  expect(place(strings.object.axes.x)[0]).toBeGreaterThan(20);
  expect(letter(up).parentElement!.dataset["up"]).toBe("true");
  expect(cross.element.lastElementChild!.textContent, "z comes towards the camera").toBe(strings.object.axes.z);
});
