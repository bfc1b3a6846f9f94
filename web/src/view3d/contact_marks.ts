// SPDX-License-Identifier: Apache-2.0
// Contacts: a ring on the surface at each contact point, and an arrow along the force on the finger, to scale. Drawn twice: once where
// they can be seen, and once more, faint, over everything, because most of an arrow lies inside the finger that it pushes. Where a finger
// slips, arrow and ring have another colour, and a second ring is around the first. Friction cones are drawn on demand.
import {
  Color, ConeGeometry, CylinderGeometry, DoubleSide, DynamicDrawUsage, Group, InstancedBufferAttribute, InstancedMesh, Matrix4, MeshBasicMaterial,
  NotEqualStencilFunc, Quaternion, ReplaceStencilOp, RingGeometry, Vector3,
} from "three";
import type { BufferGeometry } from "three";
import type { Tick } from "../gen/phalanx/tick_pb";
import { arrowLargestForce, arrowMetresPerNewton } from "./arrow_scale";
import { kSegments } from "./segments";

const kShaft = 0.0013; // radius [m]
const kHead = 0.0036; // radius [m]
const kHeadLength = 0.008; // [m], shorter where the arrow is
const kRing = 0.0052; // radius [m]
const kSmallRing = 0.0036; // of a contact point in sliding mode [m]
const kSlipRing = 1.6; // around it, of its radius
const kCone = 0.016; // from the tip of a friction cone to its rim [m]
const kLift = 0.0003; // of a ring above the surface [m]
const kOutline = 0.0006; // around a faint arrow [m]
const kMostPoints = 80; // as ContactPoints::kMost of the host
const kLeastForce = 1e-3; // [N]; less has no arrow

export interface Mark {
  readonly segment: number;
  readonly point: readonly [number, number, number];
  readonly normal: readonly [number, number, number]; // unit
  readonly force: number; // that leaves [N]
  readonly touching: boolean;
  readonly slips: boolean;
}

/// Contact point of sliding mode.
export interface PointMark {
  readonly segment: number;
  readonly point: readonly [number, number, number];
  readonly normal: readonly [number, number, number]; // of the surface, unit
  readonly coefficient: number; // of friction, not below 0
  readonly slips: boolean;
}

type Place = Pick<Mark, "point" | "normal">;

/// @returns a place from a message's numbers, or null if they are not all there
function placeOf(point: readonly number[], normal: readonly number[]): Place | null {
  const [x, y, z] = point;
  const [u, v, w] = normal;
  const length = Math.hypot(u ?? NaN, v ?? NaN, w ?? NaN);
  if (!Number.isFinite((x ?? NaN) + (y ?? NaN) + (z ?? NaN)) || !(length > 1e-6 && length < Infinity)) return null;
  return { point: [x!, y!, z!], normal: [u! / length, v! / length, w! / length] };
}

/// Reads the contacts of a tick. Those without a whole point and direction are left out.
export function marksOf(tick: Tick): Mark[] {
  const marks: Mark[] = [];
  for (const contact of tick.contact) {
    const place = placeOf(contact.point, contact.normal);
    const force = contact.force * tick.factor;
    if (contact.segment >= kSegments || !place) continue;
    marks.push({
      ...place,
      segment: contact.segment,
      force: Number.isFinite(force) && force > 0 ? force : 0,
      touching: contact.touching,
      slips: contact.slips,
    });
  }
  return marks.slice(0, kSegments);
}

/// Reads the contact points of a tick in sliding mode, likewise.
export function pointsOf(tick: Tick): PointMark[] {
  const points: PointMark[] = [];
  for (const { segment, point, normal, coefficient, slips } of tick.contactPoint) {
    const place = placeOf(point, normal);
    if (segment >= kSegments || !place) continue;
    points.push({ ...place, segment, slips, coefficient: Number.isFinite(coefficient) && coefficient > 0 ? coefficient : 0 });
  }
  return points.slice(0, kMostPoints);
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

interface Ring extends Place {
  readonly radius: number; // [m]
  readonly slips: boolean;
}

/// Rings of the segments without contact points, and of all contact points.
function ringsOf(marks: readonly Mark[], points: readonly PointMark[]): Ring[] {
  const listed = new Set(points.map((point) => point.segment));
  const single = marks.filter((mark) => !listed.has(mark.segment) && (mark.touching || arrowLength(mark.force) > 0));
  const rings = [...single.map((mark) => ({ ...mark, radius: kRing })), ...points.map((point) => ({ ...point, radius: kSmallRing }))];
  return [...rings, ...rings.filter((ring) => ring.slips).map((ring) => ({ ...ring, radius: kSlipRing * ring.radius }))];
}

export interface MarkColours {
  readonly arrow: string;
  readonly slip: string; // of arrows and rings where the finger slips
  readonly around: string; // of the faint arrows' outline
}

export class ContactMarks {
  readonly solid = new Group(); // for the scene
  readonly faint = new Group(); // for what is drawn over it
  readonly cones = new Group(); // likewise: friction cones, forces that a contact point can hold without slip
  private readonly parts: BufferGeometry[];
  private readonly solidMaterial = new MeshBasicMaterial({ toneMapped: false });
  private readonly faintMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.72, depthTest: false, depthWrite: false, ...oneLayer, stencilZPass: ReplaceStencilOp });
  private readonly outlineMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.7, depthTest: false, depthWrite: false, ...oneLayer });
  private readonly coneMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.3, side: DoubleSide, forceSinglePass: true, depthTest: false, depthWrite: false });
  private readonly meshes: InstancedMesh[] = []; // shaft, head, ring of `solid`, then of `faint`, then of the outline
  private readonly coneParts: InstancedMesh[]; // surfaces and rims
  private readonly colour = { arrow: new Color(), slip: new Color() };
  private segments: number[] = []; // of the arrows

  constructor() {
    const shaft = new CylinderGeometry(1, 1, 1, 12, 1, true).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const head = new ConeGeometry(1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const ring = new RingGeometry(0.66, 1, 40);
    const cone = new ConeGeometry(1, 1, 40, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5); // its tip at the origin
    const rim = new RingGeometry(0.95, 1, 40).translate(0, 0, 1);
    this.parts = [shaft, head, ring, cone, rim];
    const layers = [[this.solid, this.solidMaterial, 0], [this.faint, this.faintMaterial, 0], [this.faint, this.outlineMaterial, 1]] as const;
    for (const [group, material, order] of layers) {
      for (const part of [shaft, head, ring]) {
        this.meshes.push(made(part, material, part === ring ? 2 * (kSegments + kMostPoints) : kSegments, order, group, material !== this.outlineMaterial));
      }
    }
    this.coneParts = [cone, rim].map((part) => made(part, this.coneMaterial, kMostPoints, 0, this.cones, true));
    this.faint.renderOrder = 3;
    this.cones.renderOrder = 2;
  }

  show(marks: readonly Mark[], points: readonly PointMark[]): void {
    const arrows = marks.filter((mark) => arrowLength(mark.force) > 0);
    const rings = ringsOf(marks, points);
    this.segments = arrows.map((mark) => mark.segment);
    for (const [layer, grown] of [[0, 0], [1, 0], [2, kOutline]] as const) {
      this.place(this.meshes[3 * layer]!, arrows, (mark) => {
        const length = arrowLength(mark.force);
        return matrixAt(mark, -grown, kShaft + grown, length - headLength(length) + grown);
      });
      this.place(this.meshes[3 * layer + 1]!, arrows, (mark) => {
        const length = arrowLength(mark.force);
        const head = headLength(length);
        return matrixAt(mark, length - head - grown, (kHead * head) / kHeadLength + 1.6 * grown + 1e-6, head + 3.4 * grown);
      });
      this.place(this.meshes[3 * layer + 2]!, layer === 2 ? [] : rings, (ring) => matrixAt(ring, kLift, ring.radius, 1));
    }
    for (const mesh of this.coneParts) {
      this.place(mesh, points, (point) => {
        const half = Math.atan(point.coefficient);
        return matrixAt(point, 0, kCone * Math.sin(half) + 1e-6, kCone * Math.cos(half));
      });
    }
  }

  /// Visible arrows, their lengths [m] from the matrices that are drawn.
  drawn(): { segment: number; length: number; slips: boolean }[] {
    if (!this.solid.visible) return [];
    const shaft = new Matrix4();
    const head = new Matrix4();
    return this.segments.map((segment, i) => {
      this.meshes[0]!.getMatrixAt(i, shaft);
      this.meshes[1]!.getMatrixAt(i, head);
      const colour = new Color();
      this.meshes[0]!.getColorAt(i, colour);
      const slips = difference(colour, this.colour.slip) < difference(colour, this.colour.arrow); // it was rounded to single precision
      return { segment, slips, length: new Vector3().setFromMatrixColumn(shaft, 2).length() + new Vector3().setFromMatrixColumn(head, 2).length() };
    });
  }

  /// Numbers of visible rings and friction cones.
  counts(): { rings: number; cones: number } {
    return { rings: this.solid.visible ? this.meshes[2]!.count : 0, cones: this.cones.visible ? this.coneParts[0]!.count : 0 };
  }

  set visible(visible: boolean) {
    this.solid.visible = this.faint.visible = visible;
  }

  /// Holds for what is shown next.
  setColours(colours: MarkColours): void {
    this.outlineMaterial.color.set(colours.around);
    this.colour.arrow.set(colours.arrow);
    this.colour.slip.set(colours.slip);
  }

  dispose(): void {
    for (const mesh of [...this.meshes, ...this.coneParts]) mesh.dispose();
    for (const part of this.parts) part.dispose();
    this.solidMaterial.dispose();
    this.faintMaterial.dispose();
    this.outlineMaterial.dispose();
    this.coneMaterial.dispose();
  }

  private place<T extends Place & { readonly slips: boolean }>(mesh: InstancedMesh, marks: readonly T[], matrix: (mark: T) => Matrix4): void {
    marks.forEach((mark, i) => {
      mesh.setMatrixAt(i, matrix(mark));
      if (mesh.instanceColor) mesh.setColorAt(i, mark.slips ? this.colour.slip : this.colour.arrow);
    });
    mesh.count = marks.length;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }
}

function difference(a: Color, b: Color): number {
  return Math.hypot(a.r - b.r, a.g - b.g, a.b - b.b);
}

/// @param coloured  each instance has a colour of its own, from the start: a later one would need another shader
function made(part: BufferGeometry, material: MeshBasicMaterial, most: number, order: number, group: Group, coloured: boolean): InstancedMesh {
  const mesh = new InstancedMesh(part, material, most);
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  if (coloured) mesh.instanceColor = new InstancedBufferAttribute(new Float32Array(3 * most), 3).setUsage(DynamicDrawUsage);
  mesh.frustumCulled = false;
  mesh.count = 0;
  mesh.renderOrder = order;
  group.add(mesh);
  return mesh;
}

function matrixAt(mark: Place, along: number, radius: number, length: number): Matrix4 {
  const normal = new Vector3(...mark.normal);
  const place = new Vector3(...mark.point).addScaledVector(normal, along);
  return new Matrix4().compose(place, new Quaternion().setFromUnitVectors(zAxis, normal), new Vector3(radius, radius, length));
}
