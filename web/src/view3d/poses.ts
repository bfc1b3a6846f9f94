// SPDX-License-Identifier: Apache-2.0
// Pose arrays of a tick (x y z [m], unit quaternion x y z w; seven numbers a segment) and the matrices of the renderer.
import { Matrix4, Quaternion, Vector3 } from "three";
import { kSegments } from "./segments";

const kPoseNumbers = 7;
const kSmallestQuaternion = 1e-6;

const position = new Vector3();
const rotation = new Quaternion();
const one = new Vector3(1, 1, 1);

/// Segment `segment` of a pose array as a matrix. The quaternion is normalised: it comes in single precision.
/// @returns false, with `out` left as it is, if a number is missing or not finite or the quaternion is none
export function poseMatrix(poses: readonly number[], segment: number, out: Matrix4): boolean {
  const at = segment * kPoseNumbers;
  for (let i = 0; i < kPoseNumbers; ++i) {
    if (!Number.isFinite(poses[at + i])) return false;
  }
  rotation.set(poses[at + 3]!, poses[at + 4]!, poses[at + 5]!, poses[at + 6]!);
  if (rotation.length() < kSmallestQuaternion) return false;
  position.set(poses[at]!, poses[at + 1]!, poses[at + 2]!);
  out.compose(position, rotation.normalize(), one);
  return true;
}

/// All 16, or null if one of them is none: half a hand is not shown.
export function poseMatrices(poses: readonly number[]): Matrix4[] | null {
  const matrices: Matrix4[] = [];
  for (let segment = 0; segment < kSegments; ++segment) {
    const matrix = new Matrix4();
    if (!poseMatrix(poses, segment, matrix)) return null;
    matrices.push(matrix);
  }
  return matrices;
}

/// Inverses of the bind poses X_BS, for the skeleton: bone matrix = X_WS X_BS^-1.
export function bindInverses(bindPose: readonly number[]): Matrix4[] | null {
  const matrices = poseMatrices(bindPose);
  if (matrices) for (const matrix of matrices) matrix.invert();
  return matrices;
}
