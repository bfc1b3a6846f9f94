// SPDX-License-Identifier: Apache-2.0
import { Matrix4, Vector3 } from "three";
import { expect, it } from "vitest";
import { wholePicture, type Sight } from "../../../src/view3d/camera_presets";
import { CameraRig } from "../../../src/view3d/camera_rig";

/// A hand whose parts reach so far from the contact [m].
function handOf(reach: number): Sight {
  const hand = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => new Vector3(x * reach, y * reach, z * reach))));
  return { hand, object: [], palm: new Matrix4().makeRotationX(Math.PI / 2), left: false, contact: new Vector3(0.01, 0, 0) };
}

function rigAtContact() {
  const rig = new CameraRig(document.createElement("div"), () => {});
  rig.setPicture(1.6, wholePicture);
  rig.goTo("contact", handOf(0.03), null);
  const run = (sight: Sight) => {
    for (let i = 0; i < 200; ++i) rig.update(i / 60, 1 / 60, () => sight);
  };
  const distance = () => rig.camera.position.distanceTo(rig.target);
  return { rig, run, distance };
}

it("a camera that follows the contact keeps a hand in the picture that opens", () => {
  const { rig, run } = rigAtContact();
  const open = handOf(0.12);
  expect(rig.sees(open.hand)).toBe(false);
  run(open);
  expect(rig.sees(handOf(0.115).hand)).toBe(true);
});

it("the distance is the user's once they have chosen one", () => {
  const { rig, run, distance } = rigAtContact();
  rig.zoom(1.5);
  const chosen = distance();
  run(handOf(0.12));
  expect(distance()).toBeCloseTo(chosen, 6);
  rig.goTo("contact", handOf(0.12), null);
  expect(distance()).toBeGreaterThan(2 * chosen);
});
