// SPDX-License-Identifier: Apache-2.0
// Skinning with centres of rotation, as include/phalanx/hand/hand_skin.h defines it, in place of three's linear blend skinning: the bones'
// motions as the graphics card reads them, the vertices' centres, and the vertex shaders' part.
import { Matrix4, Quaternion, Skeleton, Vector3 } from "three";
import { kPalm, kSegmentsPerDigit } from "./segments";
import { kInfluences } from "./shapes";

const kRow = 16; // numbers of a bone in the texture, as in three's: quaternion, translation and 0, then 8 that are not used

const motion = new Matrix4();
const rotation = new Quaternion();
const other = new Quaternion();
const translation = new Vector3();

/// The segments' bones. Of the two signs of a motion's quaternion it has the one that is nearer to the segment before it in the digit, of
/// a first segment to the palm.
export class HandSkeleton extends Skeleton {
  override update(): void {
    this.write(kPalm);
    for (let segment = 0; segment < kPalm; ++segment) this.write(segment, segment % kSegmentsPerDigit === 0 ? kPalm : segment - 1);
    if (this.boneTexture) this.boneTexture.needsUpdate = true;
  }

  /// Moves a point by bones with weights about its centre, as the vertex shader does.
  move(point: Vector3, centre: Vector3, bones: ArrayLike<number>, weights: ArrayLike<number>): Vector3 {
    const sum = [0, 0, 0, 0];
    const to = new Vector3();
    for (let k = 0; k < bones.length; ++k) {
      const first = kRow * bones[k]!;
      rotation.fromArray(this.boneMatrices, first);
      rotation.toArray().forEach((value, i) => (sum[i]! += weights[k]! * value));
      to.addScaledVector(centre.clone().applyQuaternion(rotation).add(translation.fromArray(this.boneMatrices, first + 4)), weights[k]!);
    }
    return point.sub(centre).applyQuaternion(rotation.fromArray(sum).normalize()).add(to);
  }

  private write(segment: number, before?: number): void {
    motion.multiplyMatrices(this.bones[segment]!.matrixWorld, this.boneInverses[segment]!);
    const row = this.boneMatrices;
    rotation.setFromRotationMatrix(motion).normalize();
    if (before !== undefined && rotation.dot(other.fromArray(row, kRow * before)) < 0) rotation.set(-rotation.x, -rotation.y, -rotation.z, -rotation.w);
    rotation.toArray(row, kRow * segment);
    translation.setFromMatrixPosition(motion).toArray(row, kRow * segment + 4);
  }
}

/// Centre of rotation of a vertex, into `point`: the weighted mean of the feet of its perpendiculars to its bones' axes, without the palm's.
function centre(point: Vector3, bones: ArrayLike<number>, weights: ArrayLike<number>, frames: readonly Matrix4[], inverses: readonly Matrix4[]): void {
  const sum = new Vector3();
  let total = 0;
  for (let k = 0; k < kInfluences; ++k) {
    const segment = bones[k]!;
    if (segment === kPalm || !weights[k]) continue;
    const along = point.clone().applyMatrix4(inverses[segment]!).z;
    sum.addScaledVector(new Vector3(0, 0, along).applyMatrix4(frames[segment]!), weights[k]!);
    total += weights[k]!;
  }
  if (total > 0) point.copy(sum.divideScalar(total));
}

/// @param inverses  X_SB of the bind pose  @returns the centres of all vertices, 3 numbers each
export function centresOfRotation(position: Float32Array, bones: Uint8Array, weights: Float32Array, inverses: readonly Matrix4[]): Float32Array {
  const frames = inverses.map((inverse) => inverse.clone().invert());
  const centres = new Float32Array(position.length);
  const point = new Vector3();
  for (let i = 0; 3 * i < position.length; ++i) {
    const [first, end] = [kInfluences * i, kInfluences * (i + 1)];
    centre(point.fromArray(position, 3 * i), bones.subarray(first, end), weights.subarray(first, end), frames, inverses);
    point.toArray(centres, 3 * i);
  }
  return centres;
}

/// GLSL: movedBy(blendedBones(boneTexture), p). Needs what a SkinnedMesh's program defines, and the centres as attribute skinCentre.
const kFunctions = `
uniform highp sampler2D boneTexture;
attribute vec3 skinCentre;
struct SkinMotion { vec4 rotation; vec3 centre; };
vec4 boneRow(highp sampler2D bones, const in float bone, const in int row) {
  int texel = 4 * int(bone) + row;
  int size = textureSize(bones, 0).x;
  return texelFetch(bones, ivec2(texel % size, texel / size), 0);
}
vec3 turnedBy(const in vec4 q, const in vec3 v) {
  return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}
SkinMotion blendedBones(highp sampler2D bones) {
  SkinMotion sum = SkinMotion(vec4(0.0), vec3(0.0));
  for (int k = 0; k < 4; ++k) {
    vec4 rotation = boneRow(bones, skinIndex[k], 0);
    sum.rotation += skinWeight[k] * rotation;
    sum.centre += skinWeight[k] * (turnedBy(rotation, skinCentre) + boneRow(bones, skinIndex[k], 1).xyz);
  }
  sum.rotation = normalize(sum.rotation);
  return sum;
}
vec3 movedBy(const in SkinMotion motion, const in vec3 p) {
  return turnedBy(motion.rotation, p - skinCentre) + motion.centre;
}`;

/// A vertex shader of three's for a SkinnedMesh on a HandSkeleton.
export function withCentresOfRotation(vertexShader: string): string {
  return vertexShader
    .replace("#include <skinning_pars_vertex>", kFunctions)
    .replace("#include <skinbase_vertex>", "SkinMotion skinMotion = blendedBones(boneTexture);")
    .replace("#include <skinnormal_vertex>", "objectNormal = turnedBy(skinMotion.rotation, objectNormal);")
    .replace("#include <skinning_vertex>", "transformed = movedBy(skinMotion, transformed);");
}
