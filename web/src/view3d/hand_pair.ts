// SPDX-License-Identifier: Apache-2.0
// The shown hand and its ghost: one shape, two sets of bones.
import { Box3, Group, Matrix4, Vector3 } from "three";
import type { SkinnedMesh } from "three";
import { GhostMaterials } from "./ghost_material";
import { HandMaterial, HandShadowMaterial } from "./hand_material";
import type { Press } from "./hand_material";
import { segmentShape, skinShape } from "./hand_shape";
import type { HandShape } from "./hand_shape";
import type { Capsule } from "./object_material";
import { PosedHand } from "./posed_hand";
import type { DrawnVertex, Point } from "./posed_hand";
import type { GhostDetail } from "./quality";
import { palmLines } from "./palm_lines";
import { kPalm } from "./segments";
import type { Shapes } from "./shapes";
import type { SkinTone } from "./skin_tones";

interface Look {
  readonly shown: PosedHand;
  readonly ghost: PosedHand;
  readonly ghostMaterials: GhostMaterials;
  readonly shape: HandShape;
}

export class HandPair {
  readonly shownGroup = new Group();
  readonly ghostGroup = new Group();
  private readonly material = new HandMaterial();
  private readonly shadowMaterial = new HandShadowMaterial();
  private looks: { skin: Look | null; segments: Look | null } = { skin: null, segments: null };
  private look: Look | null = null; // the one in use
  private wantsSkin = true;
  private detail: GhostDetail = "outline";
  private ghostColour = "#ffffff";
  private poses: { gdp: readonly number[]; hcp: readonly number[] } | null = null;

  setGeometry(shapes: Shapes): void {
    this.dropLooks();
    this.poses = null; // of another hand
    const skin = skinShape(shapes.skin);
    if (skin) this.material.setPalm(skin.inverses[kPalm]!, palmLines(skin.inverses));
    this.looks = { skin: this.lookOf(skin), segments: this.lookOf(segmentShape(shapes.segments)) };
    this.choose();
  }

  useSkin(skin: boolean): void {
    this.wantsSkin = skin;
    this.choose();
  }

  /// @returns false, and nothing moves, if the shown hand is not whole; without a whole measured hand there is no ghost
  pose(gdp: readonly number[], hcp: readonly number[]): boolean {
    if (!this.look?.shown.pose(gdp)) return false;
    this.poses = { gdp, hcp };
    this.shownGroup.visible = true;
    this.look.ghost.visible = this.look.ghost.pose(hcp);
    return true;
  }

  paint(tone: SkinTone, presses: readonly Press[]): void {
    this.material.setTone(tone);
    this.material.setPresses(presses);
  }

  /// One colour: the picture is old.
  paintLost(colour: string): void {
    this.material.setLost(colour);
    this.material.setPresses([]);
  }

  /// Of the skin.
  setDetail(on: boolean): void {
    this.material.setDetail(on);
  }

  setGhostColour(colour: string): void {
    this.ghostColour = colour;
    this.looks.skin?.ghostMaterials.setColour(colour);
    this.looks.segments?.ghostMaterials.setColour(colour);
  }

  setGhostDetail(detail: GhostDetail): void {
    this.detail = detail;
    this.choose();
  }

  shownOrigins(): Point[] {
    return this.look?.shown.drawn() ?? [];
  }

  /// Some of the skin's vertices where they are drawn; none without a skin.
  shownSkin(): DrawnVertex[] {
    return this.look?.shown.drawnVertices() ?? [];
  }

  ghostOrigins(): Point[] {
    return this.look?.ghost.visible ? this.look.ghost.drawn() : [];
  }

  /// Corners of the segments' boxes, 8 a segment.
  corners(): Vector3[] {
    return this.look?.shown.corners() ?? [];
  }

  palm(): Matrix4 | null {
    return this.look?.shown.posed ? this.look.shown.frame(kPalm).clone() : null;
  }

  /// Middle of a segment's part [m], W.
  middleOf(segment: number): Vector3 | null {
    const box = this.look?.shape.boxes[segment];
    if (!this.look?.shown.posed || !box) return null;
    return (box.isEmpty() ? new Vector3() : box.getCenter(new Vector3())).applyMatrix4(this.look.shown.frame(segment));
  }

  /// The segments as capsules in W, for the shade that they throw on what is near.
  capsules(segments = kPalm): Capsule[] {
    const look = this.look;
    if (!look?.shown.posed) return [];
    return look.shape.boxes.slice(0, segments).flatMap((box, segment) => (box.isEmpty() ? [] : [capsuleIn(box, look.shown.frame(segment))]));
  }

  /// Releases the renderer's resources of both looks, visible or not. Later drawing creates them again.
  release(): void {
    this.material.dispose();
    this.shadowMaterial.dispose();
    for (const look of [this.looks.skin, this.looks.segments]) {
      look?.shown.release();
      look?.ghost.release();
      look?.ghostMaterials.dispose();
      look?.shape.geometry.dispose();
    }
  }

  dispose(): void {
    this.dropLooks();
    this.material.dispose();
    this.shadowMaterial.dispose();
  }

  private lookOf(shape: HandShape | null): Look | null {
    if (!shape) return null;
    const shown = new PosedHand(shape, [this.material]);
    for (const mesh of shown.meshes) {
      mesh.castShadow = mesh.receiveShadow = true;
      mesh.customDepthMaterial = this.shadowMaterial;
    }
    const ghostMaterials = new GhostMaterials(shown.skeleton.boneTexture!);
    ghostMaterials.setColour(this.ghostColour);
    const ghost = new PosedHand(shape, [ghostMaterials.depth, ...ghostMaterials.layers]);
    ghost.meshes.forEach((mesh, i) => (mesh.renderOrder = i)); // the depth first
    return { shown, ghost, ghostMaterials, shape };
  }

  /// Puts the requested look into the groups, at the hand's present place.
  private choose(): void {
    const next = (this.wantsSkin ? this.looks.skin : null) ?? this.looks.segments ?? this.looks.skin;
    if (next !== this.look) {
      this.shownGroup.clear();
      this.ghostGroup.clear();
      if (next) this.shownGroup.add(...next.shown.meshes);
      this.look = next;
      this.shownGroup.visible = false; // until it is known where it is
      if (next) next.ghost.visible = false;
      if (this.poses) this.pose(this.poses.gdp, this.poses.hcp);
    }
    if (!next) return;
    this.ghostGroup.clear();
    this.ghostGroup.add(...ghostMeshes(next.ghost, this.detail));
  }

  private dropLooks(): void {
    for (const look of [this.looks.skin, this.looks.segments]) {
      look?.shown.dispose();
      look?.ghost.dispose();
      look?.ghostMaterials.dispose();
      look?.shape.geometry.dispose();
    }
    this.looks = { skin: null, segments: null };
    this.look = null;
  }
}

function ghostMeshes(ghost: PosedHand, detail: GhostDetail): SkinnedMesh[] {
  const [depth, overHand, elsewhere, everywhere] = ghost.meshes;
  switch (detail) {
    case "outline":
      return [depth!, overHand!, elsewhere!];
    case "peeled":
      return [depth!, everywhere!];
    case "plain":
      return [everywhere!];
  }
}

/// Along a segment's longest axis, as thick as the middle one of the three.
function capsuleIn(box: Box3, X_WS: Matrix4): Capsule {
  const size = box.getSize(new Vector3());
  const centre = box.getCenter(new Vector3());
  const sorted = [size.x, size.y, size.z].sort((a, b) => a - b);
  const radius = sorted[1]! / 2;
  const half = Math.max(0, sorted[2]! / 2 - radius);
  const axis = new Vector3(size.x === sorted[2] ? 1 : 0, 0, 0);
  if (axis.x === 0) axis.set(0, size.y === sorted[2] ? 1 : 0, size.y === sorted[2] ? 0 : 1);
  const from = centre.clone().addScaledVector(axis, -half).applyMatrix4(X_WS);
  const to = centre.clone().addScaledVector(axis, half).applyMatrix4(X_WS);
  return { from: [from.x, from.y, from.z], to: [to.x, to.y, to.z], radius };
}
