// SPDX-License-Identifier: Apache-2.0
// Contacts: a ring on the surface at each contact point, and an arrow along the force on the finger, to scale. Drawn twice: once where
// they can be seen, and once more, faint, over everything, because most of an arrow lies inside the finger that it pushes. They have the
// digit's colour; an arrow that is computed but not felt is hollow. Where a finger slips, a dashed ring is around the ring. Friction cones
// are drawn on demand.
import {
  Color, ConeGeometry, CylinderGeometry, DoubleSide, DynamicDrawUsage, Group, InstancedBufferAttribute, InstancedMesh, Matrix4, MeshBasicMaterial,
  NotEqualStencilFunc, Quaternion, ReplaceStencilOp, RingGeometry, Vector3,
} from "three";
import type { BufferGeometry } from "three";
import type { Tick } from "../gen/phalanx/tick_pb";
import { arrowLength, forceScale, type ForceScale } from "./force_scale";
import { kPalm, kSegments, kSegmentsPerDigit } from "./segments";

const kShaft = 0.0013; // radius [m]
const kHead = 0.0036; // radius [m]
const kHeadLength = 0.008; // [m], shorter where the arrow is
const kRing = 0.0052; // radius [m]
const kSmallRing = 0.0036; // of a contact point in sliding mode [m]
const kSlipRing = 1.7; // the dashed one around it, of its radius
const kCone = 0.016; // from the tip of a friction cone to its rim [m]
const kLift = 0.0003; // of a ring above the surface [m]
const kOutline = 0.0008; // around a faint arrow [m]
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
  readonly segment: number;
  readonly radius: number; // [m]
  readonly slips: boolean;
}

/// A ring with gaps.
function dashedRing(): RingGeometry {
  const [kDashes, kCuts] = [7, 5]; // of the cuts of a dash, 3 are drawn
  const ring = new RingGeometry(0.8, 1, kDashes * kCuts);
  const perCut = 6; // numbers of the index
  ring.setIndex(Array.from(ring.getIndex()!.array).filter((_, i) => Math.floor(i / perCut) % kCuts < 3));
  return ring;
}

function hasArrow(mark: Mark): boolean {
  return mark.force >= kLeastForce;
}

/// Rings of the segments without contact points, and of all contact points.
function ringsOf(marks: readonly Mark[], points: readonly PointMark[]): Ring[] {
  const listed = new Set(points.map((point) => point.segment));
  const single = marks.filter((mark) => !listed.has(mark.segment) && (mark.touching || hasArrow(mark)));
  return [...single.map((mark) => ({ ...mark, radius: kRing })), ...points.map((point) => ({ ...point, radius: kSmallRing }))];
}

export interface MarkColours {
  readonly digits: readonly string[];
  readonly palm: string;
  readonly around: string; // of the faint arrows' outline
  readonly unfelt: string; // outline of a hollow arrow, and the ring at its foot
}

/// Of a hollow arrow the outline shows.
type Paint = "fill" | "outline";

export class ContactMarks {
  readonly solid = new Group(); // for the scene
  readonly faint = new Group(); // for what is drawn over it
  readonly cones = new Group(); // likewise: friction cones, forces that a contact point can hold without slip
  private readonly parts: BufferGeometry[];
  private readonly solidMaterial = new MeshBasicMaterial({ toneMapped: false });
  private readonly faintMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.85, depthTest: false, depthWrite: false, ...oneLayer, stencilZPass: ReplaceStencilOp });
  private readonly outlineMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.9, depthTest: false, depthWrite: false, ...oneLayer });
  private readonly coneMaterial = new MeshBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.3, side: DoubleSide, forceSinglePass: true, depthTest: false, depthWrite: false });
  private readonly meshes: InstancedMesh[] = []; // shaft, head, ring, dashed ring of `solid`, then of `faint`, then of the outline
  private readonly coneParts: InstancedMesh[]; // surfaces and rims
  private colours: MarkColours = { digits: [], palm: "#ffffff", around: "#000000", unfelt: "#808080" };
  private scale = forceScale(Infinity);
  private felt: readonly boolean[] = [];
  private arrows: readonly Mark[] = [];

  constructor() {
    const shaft = new CylinderGeometry(1, 1, 1, 12, 1, true).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const head = new ConeGeometry(1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const ring = new RingGeometry(0.66, 1, 40);
    const dashes = dashedRing();
    const cone = new ConeGeometry(1, 1, 40, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5); // its tip at the origin
    const rim = new RingGeometry(0.95, 1, 40).translate(0, 0, 1);
    this.parts = [shaft, head, ring, dashes, cone, rim];
    const layers = [[this.solid, this.solidMaterial, 0], [this.faint, this.faintMaterial, 0], [this.faint, this.outlineMaterial, 1]] as const;
    for (const [group, material, order] of layers) {
      for (const part of [shaft, head, ring, dashes]) {
        this.meshes.push(made(part, material, part === shaft || part === head ? kSegments : kSegments + kMostPoints, order, group));
      }
    }
    this.coneParts = [cone, rim].map((part) => made(part, this.coneMaterial, kMostPoints, 0, this.cones));
    this.faint.renderOrder = 3;
    this.cones.renderOrder = 2;
  }

  show(marks: readonly Mark[], points: readonly PointMark[]): void {
    const arrows = marks.filter(hasArrow);
    const rings = ringsOf(marks, points);
    const slipping = rings.filter((ring) => ring.slips);
    this.arrows = arrows;
    for (const [layer, grown] of [[0, 0], [1, 0], [2, kOutline]] as const) {
      const [shaft, head, ring, dashes] = this.meshes.slice(4 * layer, 4 * layer + 4) as [InstancedMesh, InstancedMesh, InstancedMesh, InstancedMesh];
      const paint = layer === 2 ? "outline" : "fill";
      const lengthOf = (mark: Mark): number => arrowLength(this.scale, mark.force);
      this.place(shaft, arrows, paint, (mark) => matrixAt(mark, -grown, kShaft + grown, lengthOf(mark) - headLength(lengthOf(mark)) + grown));
      this.place(head, arrows, paint, (mark) => {
        const [length, tip] = [lengthOf(mark), headLength(lengthOf(mark))];
        return matrixAt(mark, length - tip - grown, (kHead * tip) / kHeadLength + 1.6 * grown + 1e-6, tip + 3.4 * grown);
      });
      this.place(ring, layer === 2 ? [] : rings, "outline", (one) => matrixAt(one, kLift, one.radius, 1));
      this.place(dashes, layer === 2 ? [] : slipping, "outline", (one) => matrixAt(one, kLift, kSlipRing * one.radius, 1));
    }
    for (const mesh of this.coneParts) {
      this.place(mesh, points, "outline", (point) => {
        const half = Math.atan(point.coefficient);
        return matrixAt(point, 0, kCone * Math.sin(half) + 1e-6, kCone * Math.cos(half));
      });
    }
  }

  /// Visible arrows, their lengths [m] from the matrices that are drawn.
  drawn(): { segment: number; length: number; slips: boolean; felt: boolean }[] {
    if (!this.solid.visible) return [];
    const shaft = new Matrix4();
    const head = new Matrix4();
    return this.arrows.map(({ segment, slips }, i) => {
      this.meshes[0]!.getMatrixAt(i, shaft);
      this.meshes[1]!.getMatrixAt(i, head);
      const length = new Vector3().setFromMatrixColumn(shaft, 2).length() + new Vector3().setFromMatrixColumn(head, 2).length();
      return { segment, slips, felt: this.isFelt(segment), length };
    });
  }

  /// Numbers of visible rings, dashed ones among them, and friction cones.
  counts(): { rings: number; cones: number } {
    const rings = this.solid.visible ? this.meshes[2]!.count + this.meshes[3]!.count : 0;
    return { rings, cones: this.cones.visible ? this.coneParts[0]!.count : 0 };
  }

  /// Place of an arrow's tip.
  tipOf(mark: Mark): [number, number, number] {
    const length = arrowLength(this.scale, mark.force);
    return [0, 1, 2].map((k) => mark.point[k]! + length * mark.normal[k]!) as [number, number, number];
  }

  isFelt(segment: number): boolean {
    return segment === kPalm || (this.felt[Math.floor(segment / kSegmentsPerDigit)] ?? true);
  }

  /// Holds for what is shown next. @param felt  of each digit: its force can be felt
  setForces(scale: ForceScale, felt: readonly boolean[]): void {
    this.scale = scale;
    this.felt = felt;
  }

  set visible(visible: boolean) {
    this.solid.visible = this.faint.visible = visible;
  }

  /// Holds for what is shown next.
  setColours(colours: MarkColours): void {
    this.colours = colours;
  }

  dispose(): void {
    for (const mesh of [...this.meshes, ...this.coneParts]) mesh.dispose();
    for (const part of this.parts) part.dispose();
    this.solidMaterial.dispose();
    this.faintMaterial.dispose();
    this.outlineMaterial.dispose();
    this.coneMaterial.dispose();
  }

  private colourOf(segment: number, paint: Paint, isArrow: boolean): string {
    const { digits, palm, around, unfelt } = this.colours;
    const felt = this.isFelt(segment);
    const own = segment === kPalm ? palm : (digits[Math.floor(segment / kSegmentsPerDigit)] ?? palm);
    if (!isArrow) return felt ? own : unfelt;
    return (paint === "fill") === felt ? (felt ? own : unfelt) : around; // the other way round: hollow
  }

  private place<T extends Place & { readonly segment: number }>(mesh: InstancedMesh, marks: readonly T[], paint: Paint, matrix: (mark: T) => Matrix4): void {
    const isArrow = this.meshes.indexOf(mesh) % 4 < 2 && this.meshes.includes(mesh);
    marks.forEach((mark, i) => {
      mesh.setMatrixAt(i, matrix(mark));
      mesh.setColorAt(i, colour.set(this.colourOf(mark.segment, paint, isArrow)));
    });
    mesh.count = marks.length;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }
}

const colour = new Color();

/// Each instance has a colour of its own, from the start: a later one would need another shader.
function made(part: BufferGeometry, material: MeshBasicMaterial, most: number, order: number, group: Group): InstancedMesh {
  const mesh = new InstancedMesh(part, material, most);
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.instanceColor = new InstancedBufferAttribute(new Float32Array(3 * most), 3).setUsage(DynamicDrawUsage);
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
