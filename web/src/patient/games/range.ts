// SPDX-License-Identifier: Apache-2.0
// Goals of motion of the whole hand: a water flower with a petal for each digit opens and closes as the hand does (range of motion, total
// active motion, entry check). There is no mark that has to be reached: beads grow by as much as each petal moves.
import { BufferAttribute, BufferGeometry, CircleGeometry, Color, DoubleSide, Group, Mesh, MeshStandardMaterial } from "three";
import type { ExerciseNow, GameParts, MakeGame } from "../game";
import { LakeGame } from "./lake_game";
import { Hoop, bead, bounded, eased, finite, glow, kGold, shine, solid } from "./marks";

const kLength = 2.5; // of a digit's petal [m]
const kSpread = [-62, -31, 0, 31, 62].map((degrees) => (degrees * Math.PI) / 180);
const kFollow = 12; // [1/s]

/// A petal of length 1 along y, hollow towards the viewer.
function petal(width: number, foot: Color, tip: Color): BufferGeometry {
  const kRows = 16;
  const kColumns = 9;
  const places: number[] = [];
  const colours: number[] = [];
  const faces: number[] = [];
  for (let row = 0; row <= kRows; ++row) {
    const t = row / kRows;
    const half = width * Math.sin(Math.PI * t ** 0.8) * 0.56 + (1 - t) * 0.04;
    const tone = foot.clone().lerp(tip, t ** 0.8);
    for (let column = 0; column <= kColumns; ++column) {
      const s = (column / kColumns) * 2 - 1;
      places.push(s * half, t, 0.26 * s * s * half - 0.14 * Math.sin(Math.PI * t));
      const shade = 1 - 0.1 * (1 - s * s) * (1 - t);
      colours.push(tone.r * shade, tone.g * shade, tone.b * shade);
      if (row === kRows || column === kColumns) continue;
      const a = row * (kColumns + 1) + column;
      faces.push(a, a + 1, a + kColumns + 1, a + 1, a + kColumns + 2, a + kColumns + 1);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours), 3));
  geometry.setIndex(faces);
  geometry.computeVertexNormals();
  return geometry;
}

const petalMaterial = () => new MeshStandardMaterial({ vertexColors: true, roughness: 0.55, side: DoubleSide, emissive: "#8c3f5c", emissiveIntensity: 0.16 });

interface Petal {
  readonly root: Group; // turns in the picture
  readonly hinge: Group; // turns towards the viewer
  flexion: number;
}

function petalAt(geometry: BufferGeometry, length: number): Petal {
  const root = new Group();
  const hinge = new Group();
  const mesh = new Mesh(geometry, petalMaterial());
  mesh.scale.setScalar(length);
  hinge.add(mesh);
  root.add(hinge);
  return { root, hinge, flexion: 0.3 };
}

/// Turns a petal as its digit is flexed. @param angle  of the open petal in the picture [rad]
function pose(one: Petal, angle: number): void {
  const { flexion } = one;
  one.root.rotation.z = -angle * (1 - 0.8 * flexion);
  one.hinge.rotation.x = 0.1 + 0.5 * flexion;
  one.hinge.scale.set(1 - 0.1 * flexion, 1 - 0.22 * flexion, 1);
}

class FlowerGoal extends LakeGame {
  private readonly flower = new Group();
  private readonly petals: Petal[] = []; // thumb to little finger
  private readonly inner: Petal[] = []; // between them; they follow their neighbours
  private readonly ends: Group[] = []; // beads at the tips of the open hand
  private readonly shown: number[] = [0, 0, 0, 0, 0];
  private readonly bud = new Hoop(1.18, true, undefined, 14);
  private readonly heart = glow("#fff0b0", 2.2, 0.75);
  private angles: number[] = kSpread;
  private opens = 0;

  constructor(parts: GameParts) {
    super(parts, 0, { width: 6.2, height: 4.9, middle: 1.95 });
  }

  protected build(exercise: ExerciseNow): void {
    // As the drawn hand: the thumb of a right hand is to the right.
    this.angles = exercise.side === "left" ? kSpread : [...kSpread].reverse();
    const foot = new Color("#fff4d8");
    const front = petal(0.4, foot, new Color("#e9799c"));
    const back = petal(0.42, foot, new Color("#f7b7c4"));
    const leaf = petal(0.36, new Color("#9cc27a"), new Color("#4f8a5b"));
    for (const angle of [-80, -45, 45, 80].map((degrees) => (degrees * Math.PI) / 180)) {
      const sepal = petalAt(leaf, 1.35);
      sepal.root.rotation.z = -angle;
      sepal.hinge.rotation.x = 0.35;
      sepal.root.position.z = 0.12;
      this.flower.add(sepal.root);
    }
    for (let between = 0; between < 4; ++between) {
      const one = petalAt(back, kLength * 0.86);
      one.root.position.z = -0.12;
      this.inner.push(one);
      this.flower.add(one.root);
    }
    for (let digit = 0; digit < 5; ++digit) {
      const one = petalAt(front, kLength * (digit === 0 || digit === 4 ? 0.9 : 1));
      one.root.position.z = digit === 2 ? 0 : 0.03 * digit;
      this.petals.push(one);
      this.flower.add(one.root);
      const end = bead(0.1, kGold);
      this.ends.push(end);
      this.scene.add(end);
      const angle = this.angles[digit]!;
      const reach = kLength * (digit === 0 || digit === 4 ? 0.9 : 1) + 0.3;
      end.position.set(Math.sin(angle) * reach, 0.35 + Math.cos(angle) * reach, 0.1);
    }
    this.flower.position.y = 0.3;
    this.bud.root.position.set(0, 1.35, 1.5);
    this.scene.add(this.flower, this.bud.root);
    if (this.heart) {
      this.heart.position.set(0, 0.75, 0.5);
      this.scene.add(this.heart);
    }
    for (const [x, z, size] of [[0, 0.2, 1.9], [-2.3, -0.9, 1.05], [2.5, -1.4, 1.25], [1.9, 1.3, 0.75], [-1.7, 1.7, 0.6]] as const) {
      const pad = new Mesh(new CircleGeometry(size, 40, 0.35, 5.7).rotateX(-Math.PI / 2), solid(z > 1 ? "#5d9a63" : "#4c8a5e", 0.12));
      pad.position.set(x, 0.03, z);
      pad.rotation.y = x;
      pad.renderOrder = 2;
      this.scene.add(pad);
    }
  }

  protected update(exercise: ExerciseNow, dt: number): void {
    const { target } = exercise;
    const opens = target.kind === "open";
    const closes = target.kind === "close";
    const asked = (digit: number) => target.digits.length === 0 || target.digits.includes(digit);
    this.petals.forEach((one, digit) => {
      one.flexion = eased(one.flexion, bounded(finite(exercise.flexion[digit], one.flexion)), dt, kFollow);
      pose(one, this.angles[digit]!);
      const visible = opens && asked(digit);
      this.shown[digit] = eased(this.shown[digit]!, visible ? 0.5 + 1.3 * (1 - one.flexion) ** 2 : 0, dt);
      this.ends[digit]!.scale.setScalar(Math.max(0.001, this.shown[digit]!));
      this.ends[digit]!.visible = this.shown[digit]! > 0.02;
    });
    this.inner.forEach((one, at) => {
      one.flexion = (this.petals[at]!.flexion + this.petals[at + 1]!.flexion) / 2;
      pose(one, (this.angles[at]! + this.angles[at + 1]!) / 2);
    });
    const judged = this.petals.filter((_, digit) => asked(digit));
    const mean = judged.reduce((sum, one) => sum + one.flexion, 0) / Math.max(1, judged.length);
    this.opens = eased(this.opens, 1 - mean, dt);
    this.bud.step(closes, mean ** 2, dt);
    shine(this.heart, 0.7 * this.opens ** 2, dt);
    if (!this.parts.options.calm) this.flower.position.y = 0.3 + 0.012 * Math.sin(0.8 * this.time);
  }
}

export const makeFlower: MakeGame = (parts) => new FlowerGoal(parts);
