// SPDX-License-Identifier: Apache-2.0
// Where the camera stands for each preset: a direction from the hand's own axes, and a distance at which everything is in the picture.
import { Box3, Matrix4, Vector3 } from "three";
import type { CameraPreset } from "./hand_view";

export interface CameraPlace {
  readonly position: Vector3;
  readonly target: Vector3;
}

/// The visible content, in W, z up.
export interface Sight {
  readonly hand: readonly Vector3[]; // corners of its parts, in all phases of its motion
  readonly object: readonly Vector3[]; // corners; none: an empty scene
  readonly palm: Matrix4 | null; // X_WS of the palm: fingers to -z, the back to +y, the little finger of a right hand to +x
  readonly left: boolean;
  readonly contact: Vector3 | null; // the strongest; without one the grip, between thumb and index
}

/// The part of the picture that nothing covers, -1 .. 1 from left to right and from below to above.
export interface FreePart {
  readonly left: number;
  readonly right: number;
  readonly bottom: number;
  readonly top: number;
}

export const wholePicture: FreePart = { left: -1, right: 1, bottom: -1, top: 1 };

export const worldUp = new Vector3(0, 0, 1);
const kFilled = 0.82; // of the free part, by the boxes of what is in the picture: about 0.7 by hand and object themselves
const kContactFilled = 0.97; // likewise by the hand, where the camera follows a contact
const kTowardsHand = 0.55; // from the contact to the hand's middle: where that camera looks
const kSteepest = (62 * Math.PI) / 180; // of home's view down
const kFlattest = (14 * Math.PI) / 180;
const kFromBelow = (-40 * Math.PI) / 180; // straight up at the palm there is no up in the picture

/// @param fieldOfView  vertical [rad]  @param aspect  width / height
export function placeFor(preset: CameraPreset, sight: Sight, fieldOfView: number, aspect: number, free: FreePart = wholePicture): CameraPlace {
  const direction = directionFor(preset, sight);
  if (preset === "contact" && sight.contact) {
    const target = sight.contact.clone().lerp(sight.hand.length > 0 ? middle(sight.hand) : sight.contact, kTowardsHand);
    return moved(around(target, sight.hand, direction, fieldOfView, aspect, free), direction, fieldOfView, aspect, free);
  }
  return moved(fitted(nearHand(sight), direction, fieldOfView, aspect, free), direction, fieldOfView, aspect, free);
}

/// Whether all points are in the free part of the picture.
export function inPicture(points: readonly Vector3[], place: CameraPlace, fieldOfView: number, aspect: number, free: FreePart): boolean {
  const direction = place.position.clone().sub(place.target);
  const distance = direction.length();
  const { right, up } = axesOf(direction.divideScalar(Math.max(1e-9, distance)));
  const tanY = Math.tan(fieldOfView / 2);
  return points.every((point) => {
    const from = point.clone().sub(place.target);
    const depth = distance - from.dot(direction);
    const [x, y] = [from.dot(right) / (tanY * aspect * depth), from.dot(up) / (tanY * depth)];
    return depth > 0 && x >= free.left && x <= free.right && y >= free.bottom && y <= free.top;
  });
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
    case "contact":
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

function axesOf(direction: Vector3): { right: Vector3; up: Vector3 } {
  const right = new Vector3().crossVectors(worldUp, direction).normalize();
  return { right, up: new Vector3().crossVectors(direction, right) };
}

/// Slopes of the rays at the border of a part of the picture that is as large as the free one, and in the picture's middle.
function slopesOf(fieldOfView: number, aspect: number, free: FreePart): { x: number; y: number } {
  const tan = Math.tan(fieldOfView / 2);
  return { x: (tan * aspect * (free.right - free.left)) / 2, y: (tan * (free.top - free.bottom)) / 2 };
}

function middle(points: readonly Vector3[]): Vector3 {
  return new Box3().setFromPoints([...points]).getCenter(new Vector3());
}

/// The nearest place in that direction from which all points are in the picture, and in its middle.
export function fitted(points: readonly Vector3[], direction: Vector3, fieldOfView: number, aspect: number, free: FreePart = wholePicture): CameraPlace {
  const { right, up } = axesOf(direction);
  const slopes = slopesOf(fieldOfView, aspect, free);
  const [tanX, tanY] = [kFilled * slopes.x, kFilled * slopes.y];
  const target = mean(points);
  let distance = 0.3;
  for (let round = 0; round < 6; ++round) {
    distance = 0.05;
    for (const point of points) {
      const from = point.clone().sub(target);
      const depth = from.dot(direction);
      distance = Math.max(distance, depth + Math.abs(from.dot(right)) / tanX, depth + Math.abs(from.dot(up)) / tanY);
    }
    if (points.length === 0) break;
    const [x, y] = [[Infinity, -Infinity], [Infinity, -Infinity]] as [[number, number], [number, number]];
    for (const point of points) {
      const from = point.clone().sub(target);
      const depth = Math.max(1e-3, distance - from.dot(direction));
      const [slopeX, slopeY] = [from.dot(right) / depth, from.dot(up) / depth];
      [x[0], x[1], y[0], y[1]] = [Math.min(x[0], slopeX), Math.max(x[1], slopeX), Math.min(y[0], slopeY), Math.max(y[1], slopeY)];
    }
    target.addScaledVector(right, ((x[0] + x[1]) / 2) * distance);
    target.addScaledVector(up, ((y[0] + y[1]) / 2) * distance);
  }
  return { target, position: target.clone().addScaledVector(direction, distance) };
}

/// The nearest place from which the target is in the middle and all points are in the picture.
function around(target: Vector3, points: readonly Vector3[], direction: Vector3, fieldOfView: number, aspect: number, free: FreePart): CameraPlace {
  const { right, up } = axesOf(direction);
  const slopes = slopesOf(fieldOfView, aspect, free);
  let distance = 0.12;
  for (const point of points) {
    const from = point.clone().sub(target);
    const depth = from.dot(direction);
    distance = Math.max(distance, depth + Math.abs(from.dot(right)) / (kContactFilled * slopes.x), depth + Math.abs(from.dot(up)) / (kContactFilled * slopes.y));
  }
  return { target: target.clone(), position: target.clone().addScaledVector(direction, distance) };
}

/// From the middle of the picture to the middle of its free part.
function moved(place: CameraPlace, direction: Vector3, fieldOfView: number, aspect: number, free: FreePart): CameraPlace {
  const { right, up } = axesOf(direction);
  const reach = Math.tan(fieldOfView / 2) * place.position.distanceTo(place.target);
  const step = right.multiplyScalar((-reach * aspect * (free.left + free.right)) / 2).addScaledVector(up, (-reach * (free.bottom + free.top)) / 2);
  return { target: place.target.clone().add(step), position: place.position.clone().add(step) };
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
