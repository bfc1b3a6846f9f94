// SPDX-License-Identifier: Apache-2.0
// Where the hand has been in the last seconds, so that a camera holds the open and the closed hand.
import { Vector3 } from "three";

const kKept = 12; // [s]
const kApart = 0.4; // [s] between samples
const kMoved = 0.004; // [m] a hand that has moved less is where it was

interface Sample {
  time: number; // when the hand was last there [s]
  readonly extremes: readonly Vector3[]; // its farthest point in each direction
}

/// Towards the faces, edges and corners of a cube.
const kDirections = Array.from({ length: 27 }, (_, i) => new Vector3((i % 3) - 1, (Math.floor(i / 3) % 3) - 1, Math.floor(i / 9) - 1)).filter(
  (direction) => direction.lengthSq() > 0,
);

export class MotionExtent {
  private samples: Sample[] = [];
  private extremes: Vector3[] = [];
  private sampled = -Infinity;

  /// @param points  of the hand, as many in each call  @param time  not before that of the call before [s]
  add(points: readonly Vector3[], time: number): void {
    if (points.length === 0 || time - this.sampled < kApart) return;
    this.sampled = time;
    this.samples = this.samples.filter((sample) => time - sample.time <= kKept);
    const extremes = kDirections.map((direction) => farthest(points, direction));
    const known = this.samples.find((sample) => sample.extremes.every((point, i) => point.distanceTo(extremes[i]!) < kMoved));
    if (known) known.time = time;
    else this.samples.push({ time, extremes });
    this.extremes = kDirections.map((direction, i) => farthest(this.samples.map((sample) => sample.extremes[i]!), direction));
  }

  /// The outermost points of all phases of the motion.
  points(): readonly Vector3[] {
    return this.extremes;
  }

  forget(): void {
    this.samples = [];
    this.extremes = [];
    this.sampled = -Infinity;
  }
}

function farthest(points: readonly Vector3[], direction: Vector3): Vector3 {
  let best = points[0]!;
  let most = -Infinity;
  for (const point of points) {
    const reach = point.dot(direction);
    if (reach <= most) continue;
    most = reach;
    best = point;
  }
  return best;
}
