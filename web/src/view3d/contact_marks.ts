// SPDX-License-Identifier: Apache-2.0
// Contacts: a ring on the surface and an arrow along the force on the finger, to scale. Drawn twice: once where they can be seen, and
// once more, faint, over everything, because most of an arrow lies inside the finger that it pushes.
import {
  ConeGeometry, CylinderGeometry, DynamicDrawUsage, Group, InstancedMesh, Matrix4, MeshBasicMaterial, NotEqualStencilFunc, Quaternion,
  ReplaceStencilOp, RingGeometry, Vector3,
} from "three";
import type { BufferGeometry } from "three";
import type { Tick } from "../gen/phalanx/tick_pb";
import { arrowLargestForce, arrowMetresPerNewton } from "./arrow_scale";
import { kSegments } from "./segments";

const kShaft = 0.0013; // radius [m]
const kHead = 0.0036; // radius [m]
const kHeadLength = 0.008; // [m], shorter where the arrow is
const kRing = 0.0052; // radius [m]
const kLift = 0.0003; // of a ring above the surface [m]
const kOutline = 0.0006; // around a faint arrow [m]
const kLeastForce = 1e-3; // [N]; less has no arrow

export interface Mark {
  readonly segment: number;
  readonly point: readonly [number, number, number];
  readonly normal: readonly [number, number, number]; // unit
  readonly force: number; // that leaves [N]
  readonly touching: boolean;
}

/// Reads the contacts of a tick. Those without a whole point and direction are left out.
export function marksOf(tick: Tick): Mark[] {
  const marks: Mark[] = [];
  for (const contact of tick.contact) {
    const [x, y, z] = contact.point;
    const [u, v, w] = contact.normal;
    const length = Math.hypot(u ?? NaN, v ?? NaN, w ?? NaN);
    const force = contact.force * tick.factor;
    if (contact.segment >= kSegments || !Number.isFinite((x ?? NaN) + (y ?? NaN) + (z ?? NaN)) || !(length > 1e-6)) continue;
    marks.push({
      segment: contact.segment,
      point: [x!, y!, z!],
      normal: [u! / length, v! / length, w! / length],
      force: Number.isFinite(force) && force > 0 ? force : 0,
      touching: contact.touching,
    });
  }
  return marks.slice(0, kSegments);
}

/// [m]; 0: no arrow.
export function arrowLength(newtons: number): number {
  return newtons >= kLeastForce ? Math.min(newtons, arrowLargestForce) * arrowMetresPerNewton : 0;
}

/// Only where no faint arrow is yet: arrows and their parts do not shine through each other, the outline stays outside.
const kArrowStencil = 2; // a bit beside the hand's
const oneLayer = {
  stencilWrite: true,
  stencilRef: kArrowStencil,
  stencilFuncMask: kArrowStencil,
  stencilWriteMask: kArrowStencil,
  stencilFunc: NotEqualStencilFunc,
} as const;

function headLength(arrow: number): number {
  return Math.min(kHeadLength, arrow / 2);
}

const zAxis = new Vector3(0, 0, 1);

export class ContactMarks {
  readonly solid = new Group(); // for the scene
  readonly faint = new Group(); // for what is drawn over it
  private readonly parts: BufferGeometry[];
  private readonly solidMaterial = new MeshBasicMaterial({ toneMapped: false });
  private readonly faintMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.72, depthTest: false, depthWrite: false, ...oneLayer, stencilZPass: ReplaceStencilOp });
  private readonly outlineMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.7, depthTest: false, depthWrite: false, ...oneLayer });
  private readonly meshes: InstancedMesh[] = []; // shaft, head, ring of `solid`, then of `faint`, then of the outline
  private segments: number[] = []; // of the arrows

  constructor() {
    const shaft = new CylinderGeometry(1, 1, 1, 12, 1, true).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const head = new ConeGeometry(1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const ring = new RingGeometry(0.66, 1, 40);
    this.parts = [shaft, head, ring];
    const layers = [[this.solid, this.solidMaterial, 0], [this.faint, this.faintMaterial, 0], [this.faint, this.outlineMaterial, 1]] as const;
    for (const [group, material, order] of layers) {
      for (const part of this.parts) {
        const mesh = new InstancedMesh(part, material, kSegments);
        mesh.instanceMatrix.setUsage(DynamicDrawUsage);
        mesh.frustumCulled = false;
        mesh.count = 0;
        mesh.renderOrder = order;
        this.meshes.push(mesh);
        group.add(mesh);
      }
    }
    this.faint.renderOrder = 3;
  }

  show(marks: readonly Mark[]): void {
    const arrows = marks.filter((mark) => arrowLength(mark.force) > 0);
    const rings = marks.filter((mark) => mark.touching || arrowLength(mark.force) > 0);
    this.segments = arrows.map((mark) => mark.segment);
    for (const [layer, grown] of [[0, 0], [1, 0], [2, kOutline]] as const) {
      this.place(3 * layer, arrows, (mark) => {
        const length = arrowLength(mark.force);
        return matrixAt(mark, -grown, kShaft + grown, length - headLength(length) + grown);
      });
      this.place(3 * layer + 1, arrows, (mark) => {
        const length = arrowLength(mark.force);
        const head = headLength(length);
        return matrixAt(mark, length - head - grown, (kHead * head) / kHeadLength + 1.6 * grown + 1e-6, head + 3.4 * grown);
      });
      this.place(3 * layer + 2, layer === 2 ? [] : rings, (mark) => matrixAt(mark, kLift, kRing, 1));
    }
  }

  /// Visible arrows, their lengths [m] from the matrices that are drawn.
  drawn(): { segment: number; length: number }[] {
    if (!this.solid.visible) return [];
    const shaft = new Matrix4();
    const head = new Matrix4();
    return this.segments.map((segment, i) => {
      this.meshes[0]!.getMatrixAt(i, shaft);
      this.meshes[1]!.getMatrixAt(i, head);
      return { segment, length: new Vector3().setFromMatrixColumn(shaft, 2).length() + new Vector3().setFromMatrixColumn(head, 2).length() };
    });
  }

  set visible(visible: boolean) {
    this.solid.visible = this.faint.visible = visible;
  }

  setColour(colour: string, around: string): void {
    this.outlineMaterial.color.set(around);
    this.solidMaterial.color.set(colour);
    this.faintMaterial.color.set(colour);
  }

  dispose(): void {
    for (const mesh of this.meshes) mesh.dispose();
    for (const part of this.parts) part.dispose();
    this.solidMaterial.dispose();
    this.faintMaterial.dispose();
    this.outlineMaterial.dispose();
  }

  private place(part: number, marks: readonly Mark[], matrix: (mark: Mark) => Matrix4): void {
    const mesh = this.meshes[part]!;
    marks.forEach((mark, i) => mesh.setMatrixAt(i, matrix(mark)));
    mesh.count = marks.length;
    mesh.instanceMatrix.needsUpdate = true;
  }
}

function matrixAt(mark: Mark, along: number, radius: number, length: number): Matrix4 {
  const normal = new Vector3(...mark.normal);
  const place = new Vector3(...mark.point).addScaledVector(normal, along);
  return new Matrix4().compose(place, new Quaternion().setFromUnitVectors(zAxis, normal), new Vector3(radius, radius, length));
}
