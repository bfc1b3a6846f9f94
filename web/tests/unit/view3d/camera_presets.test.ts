// SPDX-License-Identifier: Apache-2.0
import { Matrix4, PerspectiveCamera, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { between, directionFor, fitted, inPicture, orbited, placeFor, wholePicture, worldUp } from "../../../src/view3d/camera_presets";
import type { CameraPlace, Sight } from "../../../src/view3d/camera_presets";
import type { CameraPreset } from "../../../src/view3d/hand_view";

const presets: CameraPreset[] = ["home", "palm", "thumb", "contact"];
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
    contact: new Vector3(left ? 0.03 : -0.03, 0.05, 0.01),
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
      it(`${preset} has hand and object in the picture, and fills about 80 % of it with their boxes (aspect ${aspect})`, () => {
        const sight = palmDown(false);
        const project = pictureOf(placeFor(preset, sight, fieldOfView, aspect), aspect);
        let most = 0;
        for (const point of [...sight.hand, ...sight.object]) {
          const seen = project(point);
          most = Math.max(most, Math.abs(seen.x), Math.abs(seen.y));
        }
        expect(most).toBeLessThan(0.88);
        expect(most).toBeGreaterThan(0.75);
      });
      it(`${preset} keeps clear of what covers the picture (aspect ${aspect})`, () => {
        const sight = palmDown(false);
        const free = { left: -1, right: 0.6, bottom: -0.5, top: 1 };
        const place = placeFor(preset, sight, fieldOfView, aspect, free);
        expect(inPicture([...sight.hand, ...sight.object], place, fieldOfView, aspect, free)).toBe(true);
        const project = pictureOf(place, aspect);
        const seen = [...sight.hand, ...sight.object].map(project);
        const shares = [seen.map(({ x }) => x / 1.6), seen.map(({ y }) => y / 1.5)].map((along) => Math.max(...along) - Math.min(...along));
        expect(Math.max(...shares)).toBeGreaterThan(0.65);
        expect(Math.max(...shares)).toBeLessThan(0.98);
      });
    }
  }
  it("does not lose the hand before an object as large as a cupboard", () => {
    const sight = { ...palmDown(false), object: box(new Vector3(-1, 0.1, -1), new Vector3(1, 2, 1)) };
    expect(placeFor("home", sight, fieldOfView, 1.3).position.distanceTo(new Vector3())).toBeLessThan(2);
  });
  it("has contact and hand in the picture when it follows the contact, nearer its middle than at home", () => {
    const sight = palmDown(false);
    for (const aspect of [0.6, 1.3, 2.5]) {
      const place = placeFor("contact", sight, fieldOfView, aspect);
      expect(inPicture([...sight.hand, sight.contact!], place, fieldOfView, aspect, wholePicture)).toBe(true);
      const seen = pictureOf(place, aspect)(sight.contact!);
      expect(Math.max(Math.abs(seen.x), Math.abs(seen.y))).toBeLessThan(0.6);
    }
  });
  it("finds a place with nothing to see", () => {
    const nothing: Sight = { hand: [], object: [], palm: null, left: false, contact: null };
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
  it("by hand: a square of 2 m, seen from the front at 90 degrees, fills 0.82 of the picture", () => {
    const place = fitted(box(new Vector3(-1, 0, -1), new Vector3(1, 0, 1)), new Vector3(0, -1, 0), Math.PI / 2, 1);
    expect(place.target.length()).toBeCloseTo(0, 9);
    expect(place.position.y).toBeCloseTo(-1 / 0.82, 9);
  });
});

describe("inPicture", () => {
  const place = { target: new Vector3(), position: new Vector3(0, -2, 0) };
  it("says what the camera sees: at 90 degrees and 2 m, 2 m to each side; nothing behind it", () => {
    const seen = (x: number, y: number, z: number): boolean => inPicture([new Vector3(x, y, z)], place, Math.PI / 2, 1, wholePicture);
    expect([seen(1.9, 0, 0), seen(0, 0, -1.9), seen(2.1, 0, 0), seen(0, 0, 2.1), seen(0, -3, 0)]).toEqual([true, true, false, false, false]);
    expect(inPicture([], place, Math.PI / 2, 1, wholePicture)).toBe(true);
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
