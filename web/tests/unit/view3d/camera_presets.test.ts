// SPDX-License-Identifier: Apache-2.0
import { Matrix4, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { between, directionFor, fitted, orbited, placeFor, worldUp } from "../../../src/view3d/camera_presets";
import type { CameraPlace, Sight } from "../../../src/view3d/camera_presets";
import type { CameraPreset } from "../../../src/view3d/hand_view";

const presets: CameraPreset[] = ["home", "palm", "thumb", "follow"];
const fieldOfView = (30 * Math.PI) / 180;

function box(min: Vector3, max: Vector3): Vector3[] {
  return Array.from({ length: 8 }, (_, i) => new Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z));
}

/// Palm down, fingers to +y; the hand above a ball.
function palmDown(left: boolean): Sight {
  const palm = new Matrix4().makeRotationX(Math.PI / 2).setPosition(0, -0.1, 0.1);
  return {
    hand: box(new Vector3(-0.05, -0.1, 0.02), new Vector3(0.05, 0.1, 0.12)),
    object: box(new Vector3(-0.03, 0, -0.03), new Vector3(0.03, 0.06, 0.03)),
    palm,
    left,
    grip: new Vector3(left ? 0.03 : -0.03, 0.05, 0.01),
  };
}

function pictureOf(place: CameraPlace, aspect: number): (point: Vector3) => Vector3 {
  const camera = new PerspectiveCamera(30, aspect, 0.01, 12);
  camera.up.copy(worldUp);
  camera.position.copy(place.position);
  camera.lookAt(place.target);
  camera.updateMatrixWorld();
  return (point) => point.clone().project(camera);
}

describe("placeFor", () => {
  for (const aspect of [0.6, 1, 1.9]) {
    for (const preset of ["home", "palm", "thumb"] as const) {
      it(`${preset} has hand and object in the picture, and fills it (aspect ${aspect})`, () => {
        const sight = palmDown(false);
        const project = pictureOf(placeFor(preset, sight, fieldOfView, aspect), aspect);
        let most = 0;
        for (const point of [...sight.hand, ...sight.object]) {
          const seen = project(point);
          most = Math.max(most, Math.abs(seen.x), Math.abs(seen.y));
        }
        expect(most).toBeLessThan(1);
        expect(most).toBeGreaterThan(0.8);
      });
    }
  }
  it("does not lose the hand before an object as large as a cupboard", () => {
    const sight = { ...palmDown(false), object: box(new Vector3(-1, 0.1, -1), new Vector3(1, 2, 1)) };
    expect(placeFor("home", sight, fieldOfView, 1.3).position.distanceTo(new Vector3())).toBeLessThan(2);
  });
  it("has the grip in the middle when it follows", () => {
    const sight = palmDown(false);
    const place = placeFor("follow", sight, fieldOfView, 1.3);
    expect(place.target.distanceTo(sight.grip!)).toBe(0);
  });
  it("finds a place with nothing to see", () => {
    const nothing: Sight = { hand: [], object: [], palm: null, left: false, grip: null };
    for (const preset of presets) {
      const place = placeFor(preset, nothing, fieldOfView, 1);
      expect(Number.isFinite(place.position.length())).toBe(true);
      expect(place.position.distanceTo(place.target)).toBeGreaterThan(0.01);
    }
  });
});

describe("directionFor", () => {
  it("looks from the thumb's side: -x of a right hand, +x of a left one", () => {
    expect(directionFor("thumb", palmDown(false)).x).toBeLessThan(-0.9);
    expect(directionFor("thumb", palmDown(true)).x).toBeGreaterThan(0.9);
  });
  it("looks at the palm from its own side, wherever that is", () => {
    expect(directionFor("palm", palmDown(false)).z).toBeLessThan(-0.5);
    const palmUp = { ...palmDown(false), palm: new Matrix4().makeRotationX(-Math.PI / 2) };
    expect(directionFor("palm", palmUp).z).toBeGreaterThan(0.5);
  });
  it("mirrors with the hand", () => {
    for (const preset of presets) {
      const right = directionFor(preset, palmDown(false));
      const left = directionFor(preset, palmDown(true));
      expect(left.x).toBeCloseTo(-right.x, 12);
      expect(left.y).toBeCloseTo(right.y, 12);
      expect(left.z).toBeCloseTo(right.z, 12);
    }
  });
  it("looks at home from above, at no hand from straight above or below, however it is held (seed 7)", () => {
    let seed = 7;
    const random = (): number => (seed = (seed * 16807) % 2147483647) / 2147483647;
    for (let i = 0; i < 500; ++i) {
      const palm = new Matrix4().makeRotationAxis(new Vector3(random() - 0.5, random() - 0.5, random() - 0.5).normalize(), 2 * Math.PI * random());
      for (const preset of presets) {
        const direction = directionFor(preset, { ...palmDown(random() < 0.5), palm });
        expect(direction.length()).toBeCloseTo(1, 9);
        expect(Math.abs(direction.z)).toBeLessThan(0.9);
        if (preset === "home") expect(direction.z).toBeGreaterThan(0.2);
      }
    }
  });
});

describe("fitted", () => {
  it("by hand: a square of 2 m, seen from the front at 90 degrees, fills the picture at 1 m times the margin", () => {
    const place = fitted(box(new Vector3(-1, 0, -1), new Vector3(1, 0, 1)), new Vector3(0, -1, 0), Math.PI / 2, 1);
    expect(place.target.length()).toBeCloseTo(0, 9);
    expect(place.position.y).toBeCloseTo(-1.12, 9);
  });
});

describe("orbited", () => {
  const place = { target: new Vector3(1, 2, 3), position: new Vector3(2, 2, 3) };
  it("turns about the world's up: a quarter turn takes +x to +y", () => {
    const turned = orbited(place, Math.PI / 2, 0).position;
    expect(turned.distanceTo(new Vector3(1, 3, 3))).toBeLessThan(1e-12);
  });
  it("keeps its distance and stops before the pole", () => {
    const above = orbited(place, 0.3, 5);
    expect(above.position.distanceTo(place.target)).toBeCloseTo(1, 12);
    expect(above.position.z - place.target.z).toBeLessThan(0.9999);
  });
});

describe("between", () => {
  const a = { target: new Vector3(), position: new Vector3(1, 0, 0) };
  it("begins at the one and ends at the other", () => {
    const b = { target: new Vector3(0, 0, 1), position: new Vector3(0, 2, 1) };
    expect(between(a, b, 0).position.distanceTo(a.position)).toBeLessThan(1e-12);
    expect(between(a, b, 1).position.distanceTo(b.position)).toBeLessThan(1e-12);
  });
  it("does not fly through the target to the opposite side", () => {
    const b = { target: new Vector3(), position: new Vector3(-1, 0, 0) };
    expect(between(a, b, 0.5).position.length()).toBeCloseTo(1, 9);
  });
});
