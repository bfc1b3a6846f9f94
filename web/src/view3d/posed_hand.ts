// SPDX-License-Identifier: Apache-2.0
// A hand's surface at the poses of a tick: 16 bones that stand directly in the world.
import { Bone, Matrix4, SkinnedMesh, Vector3 } from "three";
import type { Material } from "three";
import type { HandShape } from "./hand_shape";
import { poseMatrices } from "./poses";
import { kSegments } from "./segments";
import { kInfluences } from "./shapes";
import { HandSkeleton } from "./skinning";

export type Point = readonly [number, number, number];

/// A vertex of the station's skin, by its number there, where it is drawn [m].
export interface DrawnVertex {
  readonly vertex: number;
  readonly at: Point;
}

const kProbed = 64; // vertices of the skin

/// One skeleton, under one or several meshes of the same shape (a ghost is drawn twice).
export class PosedHand {
  readonly meshes: readonly SkinnedMesh[];
  readonly skeleton: HandSkeleton;
  posed = false; // it has been somewhere

  constructor(private readonly shape: HandShape, materials: readonly Material[]) {
    const bones = shape.inverses.map(() => {
      const bone = new Bone();
      bone.matrixAutoUpdate = bone.matrixWorldAutoUpdate = false;
      return bone;
    });
    this.skeleton = new HandSkeleton(bones, shape.inverses.map((matrix) => matrix.clone()));
    this.skeleton.computeBoneTexture();
    this.meshes = materials.map((material) => {
      const mesh = new SkinnedMesh(shape.geometry, material);
      mesh.bind(this.skeleton, new Matrix4());
      mesh.frustumCulled = false; // its box in the bind pose does not bound the posed hand
      mesh.matrixAutoUpdate = false;
      return mesh;
    });
  }

  /// X_WS of the 16 segments, as in a tick. @returns false, and nothing moves, if they are not whole
  pose(poses: readonly number[]): boolean {
    const matrices = poseMatrices(poses);
    if (!matrices) return false;
    matrices.forEach((matrix, segment) => this.skeleton.bones[segment]!.matrixWorld.copy(matrix));
    this.skeleton.update();
    this.posed = true;
    return true;
  }

  /// Origin of each segment's frame [m], worked back from the bones' motions as the graphics card has them.
  drawn(): Point[] {
    if (!this.posed) return [];
    const origin = new Vector3();
    return Array.from({ length: kSegments }, (_, segment): Point => {
      origin.setFromMatrixPosition(new Matrix4().copy(this.shape.inverses[segment]!).invert());
      this.skeleton.move(origin, origin.clone(), [segment], [1]);
      return [origin.x, origin.y, origin.z];
    });
  }

  /// Vertices all over the skin, moved by the bones as the graphics card moves them.
  drawnVertices(): DrawnVertex[] {
    const { source, geometry } = this.shape;
    if (!this.posed) return [];
    const position = geometry.getAttribute("position");
    const centre = geometry.getAttribute("skinCentre");
    const bone = geometry.getAttribute("skinIndex").array;
    const weight = geometry.getAttribute("skinWeight").array;
    const point = new Vector3();
    const about = new Vector3();
    const count = Math.min(kProbed, source.length);
    return Array.from({ length: count }, (_, i): DrawnVertex => {
      const at = Math.floor((i * source.length) / count);
      point.fromBufferAttribute(position, at);
      const [first, end] = [kInfluences * at, kInfluences * (at + 1)];
      about.fromBufferAttribute(centre, at);
      this.skeleton.move(point, about, bone.slice(first, end), weight.slice(first, end));
      return { vertex: source[at]!, at: [point.x, point.y, point.z] };
    });
  }

  /// X_WS of a segment.
  frame(segment: number): Matrix4 {
    return this.skeleton.bones[segment]!.matrixWorld;
  }

  /// Corners of the segments' boxes in W: what a camera has to see.
  corners(): Vector3[] {
    const points: Vector3[] = [];
    if (!this.posed) return points;
    this.shape.boxes.forEach((box, segment) => {
      if (box.isEmpty()) return;
      for (let i = 0; i < 8; ++i) {
        const corner = new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z);
        points.push(corner.applyMatrix4(this.frame(segment)));
      }
    });
    return points;
  }

  get visible(): boolean {
    return this.meshes.every((mesh) => mesh.visible);
  }
  set visible(visible: boolean) {
    for (const mesh of this.meshes) mesh.visible = visible;
  }

  /// Releases the texture of the bones.
  release(): void {
    this.skeleton.boneTexture?.dispose();
  }

  /// Removes the meshes and disposes of the skeleton. The shape belongs to the caller that made it.
  dispose(): void {
    for (const mesh of this.meshes) mesh.removeFromParent();
    this.skeleton.dispose();
  }
}
