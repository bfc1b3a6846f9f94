// SPDX-License-Identifier: Apache-2.0
// Where the camera stands for each preset: a direction from the hand's own axes, and a distance at which everything is in the picture.
import { Matrix4, Vector3 } from "three";
import type { CameraPreset } from "./hand_view";

export interface CameraPlace {
  readonly position: Vector3;
  readonly target: Vector3;
}

/// The visible content, in W, z up.
export interface Sight {
  readonly hand: readonly Vector3[]; // corners of its parts
  readonly object: readonly Vector3[]; // corners; none: an empty scene
  readonly palm: Matrix4 | null; // X_WS of the palm: fingers to -z, the back to +y, the little finger of a right hand to +x
  readonly left: boolean;
  readonly grip: Vector3 | null; // between thumb and index
}

export const worldUp = new Vector3(0, 0, 1);
const kMargin = 1.12; // of the picture around what is in it
const kGripReach = 0.055; // half of what "follow" shows [m]
const kSteepest = (62 * Math.PI) / 180; // of home's view down
const kFlattest = (14 * Math.PI) / 180;
const kFromBelow = (-40 * Math.PI) / 180; // straight up at the palm there is no up in the picture

/// @param fieldOfView  vertical [rad]  @param aspect  width / height
export function placeFor(preset: CameraPreset, sight: Sight, fieldOfView: number, aspect: number): CameraPlace {
  const direction = directionFor(preset, sight);
  if (preset === "follow" && sight.grip) {
    const reach = kGripReach / Math.sin(Math.min(fieldOfView, 2 * Math.atan(Math.tan(fieldOfView / 2) * aspect)) / 2);
    return { target: sight.grip.clone(), position: sight.grip.clone().addScaledVector(direction, reach) };
  }
  return fitted(nearHand(sight), direction, fieldOfView, aspect);
}

/// Unit vector from what is looked at towards the camera.
export function directionFor(preset: CameraPreset, sight: Sight): Vector3 {
  const x = new Vector3(1, 0, 0);
  const back = new Vector3(0, 1, 0);
  const wrist = new Vector3(0, 0, 1);
  (sight.palm ?? new Matrix4().makeRotationX(Math.PI / 2)).extractBasis(x, back, wrist);
  const thumb = x.multiplyScalar(sight.left ? 1 : -1);
  const mix = (t: number, f: number, b: number, up: number): Vector3 =>
    new Vector3().addScaledVector(thumb, t).addScaledVector(wrist, -f).addScaledVector(back, b).addScaledVector(worldUp, up);
  switch (preset) {
    case "palm":
      return elevated(mix(0.3, 0.6, -1, 0), kFromBelow, kSteepest);
    case "thumb":
      return elevated(mix(1, 0.12, 0.05, 0.16), -0.3, kSteepest);
    case "follow":
      return elevated(mix(0.85, 0.4, 0.1, 0.25), -0.2, kSteepest);
    case "home":
      return elevated(mix(0.72, 0.5, 0.2, 0.42), kFlattest, kSteepest);
  }
}

/// The same azimuth, the elevation within its bounds.
function elevated(direction: Vector3, lowest: number, highest: number): Vector3 {
  const flat = Math.hypot(direction.x, direction.y);
  const azimuth = flat > 1e-6 ? Math.atan2(direction.y, direction.x) : -Math.PI / 2;
  const elevation = Math.min(highest, Math.max(lowest, Math.atan2(direction.z, flat)));
  return new Vector3(Math.cos(azimuth) * Math.cos(elevation), Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation));
}

/// Hand and object, unless the object is so much larger that the hand would be lost: then what is near the hand.
function nearHand(sight: Sight): readonly Vector3[] {
  if (sight.hand.length === 0) return sight.object;
  const centre = mean(sight.hand);
  const reach = 2 * Math.max(...sight.hand.map((point) => point.distanceTo(centre)));
  const clamped = sight.object.map((point) => point.clone().sub(centre).clampLength(0, reach).add(centre));
  return [...sight.hand, ...clamped];
}

function mean(points: readonly Vector3[]): Vector3 {
  const sum = new Vector3();
  for (const point of points) sum.add(point);
  return sum.divideScalar(Math.max(1, points.length));
}

/// The nearest place in that direction from which all points are in the picture, and in its middle.
export function fitted(points: readonly Vector3[], direction: Vector3, fieldOfView: number, aspect: number): CameraPlace {
  const right = new Vector3().crossVectors(worldUp, direction).normalize();
  const up = new Vector3().crossVectors(direction, right);
  const tanY = Math.tan(fieldOfView / 2) / kMargin;
  const tanX = (Math.tan(fieldOfView / 2) * aspect) / kMargin;
  const target = mean(points);
  let distance = 0.3;
  for (let round = 0; round < 6; ++round) {
    distance = 0.05;
    for (const point of points) {
      const from = point.clone().sub(target);
      const depth = from.dot(direction);
      distance = Math.max(distance, depth + Math.abs(from.dot(right)) / tanX, depth + Math.abs(from.dot(up)) / tanY);
    }
    const slopesX: number[] = [];
    const slopesY: number[] = [];
    for (const point of points) {
      const from = point.clone().sub(target);
      const depth = Math.max(1e-3, distance - from.dot(direction));
      slopesX.push(from.dot(right) / depth);
      slopesY.push(from.dot(up) / depth);
    }
    if (points.length === 0) break;
    target.addScaledVector(right, ((Math.max(...slopesX) + Math.min(...slopesX)) / 2) * distance);
    target.addScaledVector(up, ((Math.max(...slopesY) + Math.min(...slopesY)) / 2) * distance);
  }
  return { target, position: target.clone().addScaledVector(direction, distance) };
}

/// Turned about the target: `right` about the world's up, `upwards` towards it, never over the poles [rad].
export function orbited(place: CameraPlace, right: number, upwards: number): CameraPlace {
  const from = place.position.clone().sub(place.target);
  const distance = from.length();
  const azimuth = Math.atan2(from.y, from.x) + right;
  const kPole = (88 * Math.PI) / 180;
  const elevation = Math.min(kPole, Math.max(-kPole, Math.asin(Math.min(1, Math.max(-1, from.z / distance))) + upwards));
  from.set(Math.cos(azimuth) * Math.cos(elevation), Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation));
  return { target: place.target, position: place.target.clone().addScaledVector(from, distance) };
}

/// Between two places: the target straight, the camera around it.
export function between(a: CameraPlace, b: CameraPlace, share: number): CameraPlace {
  const target = a.target.clone().lerp(b.target, share);
  const from = a.position.clone().sub(a.target);
  const to = b.position.clone().sub(b.target);
  const distance = from.length() + (to.length() - from.length()) * share;
  const direction = from.normalize().lerp(to.normalize(), share);
  if (direction.lengthSq() < 1e-6) direction.copy(to); // opposite: straight over
  return { target, position: target.clone().addScaledVector(direction.normalize(), distance) };
}
