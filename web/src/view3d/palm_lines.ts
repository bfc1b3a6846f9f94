// SPDX-License-Identifier: Apache-2.0
// The three creases of the palm as arcs of circles in its frame S, from where the fingers' roots are.
import { Matrix4, Vector2, Vector3, Vector4 } from "three";
import { kPalm, kSegmentsPerDigit } from "./segments";

export interface PalmLine {
  readonly circle: Vector4; // centre x z, radius [m], 0
  readonly reach: Vector4; // begin x z, and a vector whose product with a place from there is 0 at the begin and 1 at the end
}

export const kPalmLines = 3;

/// Points of a line: across the knuckles, from the index finger's (0) to the little finger's (1), and from the fingers to the wrist, in
/// breadths of the knuckles.
const kLines: readonly (readonly (readonly [across: number, down: number])[])[] = [
  [[1.28, 0.34], [0.66, 0.4], [0.22, 0.1]],
  [[-0.24, 0.36], [0.42, 0.58], [1.02, 0.95]],
  [[-0.24, 0.4], [0.3, 0.86], [0.3, 1.42]],
];

/// @param inverses  X_SB of the bind pose
export function palmLines(inverses: readonly Matrix4[]): PalmLine[] {
  const root = (digit: number): Vector2 => {
    const at = new Vector3().setFromMatrixPosition(inverses[kSegmentsPerDigit * digit]!.clone().invert()).applyMatrix4(inverses[kPalm]!);
    return new Vector2(at.x, at.z);
  };
  const [index, little] = [root(1), root(4)];
  const across = little.clone().sub(index);
  const down = new Vector2(-across.y, across.x); // as long as the knuckles are broad
  if (down.y < 0) down.negate(); // the wrist is at +z
  return kLines.map((line) => {
    const [a, b, c] = line.map(([x, y]) => index.clone().addScaledVector(across, x).addScaledVector(down, y)) as [Vector2, Vector2, Vector2];
    const centre = circleThrough(a, b, c);
    const chord = c.clone().sub(a);
    chord.divideScalar(Math.max(1e-12, chord.lengthSq()));
    return { circle: new Vector4(centre.x, centre.y, centre.distanceTo(a), 0), reach: new Vector4(a.x, a.y, chord.x, chord.y) };
  });
}

/// @returns its centre
function circleThrough(a: Vector2, b: Vector2, c: Vector2): Vector2 {
  const [p, q] = [b.clone().sub(a), c.clone().sub(a)];
  const cross = 2 * (p.x * q.y - p.y * q.x);
  if (Math.abs(cross) < 1e-15) return a.clone();
  const [pp, qq] = [p.lengthSq(), q.lengthSq()];
  return new Vector2((q.y * pp - p.y * qq) / cross, (p.x * qq - q.x * pp) / cross).add(a);
}
