// SPDX-License-Identifier: Apache-2.0
// Feel and find: two sponges, or an object, under cloths. While the scene is hidden the picture depends on nothing but the phase, its time,
// the number of the sponge and the words that the patient gets: not on the hand, a force, a depth or a contact. It makes no sound.
import { BoxGeometry, BufferAttribute, BufferGeometry, Color, CylinderGeometry, DoubleSide, Group, Mesh, MeshStandardMaterial, SphereGeometry } from "three";
import { DrawnHand } from "../demonstration";
import type { ExerciseNow, Free, GameParts, MakeGame } from "../game";
import { LakeGame, kShift } from "./lake_game";
import { Hoop, bead, dispose, eased, kPaper, solid } from "./marks";

/// A cloth over something round, with folds that say nothing of it.
function cloth(turn: number): BufferGeometry {
  const kRows = 22;
  const kColumns = 72;
  const places: number[] = [];
  const faces: number[] = [];
  const colours: number[] = [];
  const ground = new Color("#d9c7ee");
  const hem = new Color("#8a6fb5");
  for (let row = 0; row <= kRows; ++row) {
    const t = row / kRows;
    for (let column = 0; column <= kColumns; ++column) {
      const angle = (column / kColumns) * 2 * Math.PI;
      const fold = 0.11 * t ** 2.2 * (Math.sin(7 * angle + turn) + 0.5 * Math.sin(11 * angle + 2 * turn));
      const radius = 0.86 * Math.sin(Math.min(1, t * 1.25) * (Math.PI / 2)) + 0.3 * t ** 3 + fold;
      const y = 1.12 * Math.cos(Math.min(1, t * 1.02) * (Math.PI / 2)) ** 0.8 + 0.03 * Math.sin(5 * angle) * t;
      places.push(radius * Math.cos(angle), Math.max(0.01, y), radius * Math.sin(angle));
      const tone = row === kRows - 3 || row === kRows - 4 || row === kRows - 6 ? hem : ground;
      colours.push(tone.r, tone.g, tone.b);
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

const kApart = 1.75; // of a cloth from the middle [m]
const kTable = 0.42; // height of its top [m]
const kHold = /^Stop, and hold it\.$/; // what the station says at the end position

/// Shape of an object whose name is shown, by words of its title; anything else is a stone.
export function shapeOf(title: string): "ball" | "cube" | "cylinder" | "stone" {
  if (/ball|sphere|orange|apple/i.test(title)) return "ball";
  if (/cube|box|block|dice/i.test(title)) return "cube";
  if (/cylinder|can|bottle|roll|tube|stick|pen/i.test(title)) return "cylinder";
  return "stone";
}

const kColours = { ball: "#f2a98f", cube: "#8fb9cf", cylinder: "#a9c99a", stone: "#c9c3b4" }; // as the pictures of the answers

function object(title: string): Mesh {
  const kinds = { ball: () => new SphereGeometry(0.5, 36, 24), cube: () => new BoxGeometry(0.82, 0.82, 0.82), cylinder: () => new CylinderGeometry(0.36, 0.36, 1.02, 36), stone: () => new SphereGeometry(0.46, 9, 6) };
  const kind = shapeOf(title);
  const mesh = new Mesh(kinds[kind](), solid(kColours[kind], 0.12));
  mesh.position.y = kind === "ball" ? 0.5 : kind === "cube" ? 0.41 : kind === "cylinder" ? 0.51 : 0.4;
  if (kind === "cube") mesh.rotation.y = 0.62;
  return mesh;
}

/// Small stones in a row: one for the first, two for the second.
function pebbles(count: number): Group {
  const row = new Group();
  for (let at = 0; at < count; ++at) {
    const one = bead(0.085, kPaper);
    one.position.x = (at - (count - 1) / 2) * 0.27;
    row.add(one);
  }
  return row;
}

interface Covered {
  readonly root: Group;
  readonly hoop: Hoop;
  shown: number;
}

class FeelGame extends LakeGame {
  private readonly covered: Covered[] = [];
  private readonly choices = new Group();
  private readonly sign = document.createElement("div");
  private named = "";
  private choosing = 0;

  constructor(parts: GameParts) {
    super(parts, 0.75, { width: 7.1, height: 3.6, middle: 1.1 });
    const hand = new DrawnHand("right");
    hand.element.style.cssText = "width:70%;height:84%;display:block;margin:8% auto";
    this.sign.className = "hold-sign";
    this.sign.style.cssText = "position:absolute;border-radius:50%;background:#fff6e4;border:6px solid #17344a;transform:translate(-50%,-50%);opacity:0;transition:opacity .35s;box-sizing:border-box";
    this.sign.append(hand.element);
  }

  override size(width: number, height: number, free: Free): void {
    super.size(width, height, free);
    const edge = Math.min(180, 0.3 * Math.min(free.width, free.height));
    const { cues } = this.parts.options;
    const shift = cues === "centre" || width < height ? 0 : (cues === "left" ? -kShift : kShift) * width;
    Object.assign(this.sign.style, { left: `${free.left + free.width / 2 + shift}px`, top: `${free.top + edge / 2 + 8}px`, width: `${edge}px`, height: `${edge}px` });
  }

  protected build(exercise: ExerciseNow): void {
    const table = new Group();
    for (let plank = 0; plank < 6; ++plank) {
      const board = new Mesh(new BoxGeometry(7.6, 0.12, 0.6), solid(plank % 2 === 0 ? "#a9805b" : "#9a7350", 0.06));
      board.position.set(0, kTable - 0.06, 1.95 - plank * 0.63);
      table.add(board);
    }
    for (const x of [-3.2, 3.2]) for (const z of [1.9, -1]) {
      const post = new Mesh(new CylinderGeometry(0.14, 0.16, 1, 14), solid("#6d4f37", 0.05));
      post.position.set(x, 0, z);
      table.add(post);
    }
    this.scene.add(table);
    const pair = exercise.measure !== "object_in_hand";
    for (const index of pair ? [0, 1] : [0]) {
      const root = new Group();
      const cover = new Mesh(cloth(1.3), new MeshStandardMaterial({ vertexColors: true, roughness: 0.9, side: DoubleSide, emissive: "#5b4a78", emissiveIntensity: 0.12 }));
      cover.scale.setScalar(pair ? 1 : 1.15);
      root.add(cover);
      root.position.set(pair ? (index === 0 ? -kApart : kApart) : 0, kTable, 0);
      if (pair) {
        const count = pebbles(index + 1);
        count.position.set(root.position.x, kTable + 0.1, 1.85);
        this.scene.add(count);
      }
      const hoop = new Hoop(pair ? 1.34 : 1.5, false, kPaper, 14);
      hoop.root.position.set(root.position.x, kTable + 0.09, 0);
      this.covered.push({ root, hoop, shown: 1 });
      this.scene.add(root, hoop.root);
    }
    this.choices.position.set(0, kTable, 0.3);
    this.scene.add(this.choices);
  }

  protected update(exercise: ExerciseNow, dt: number): void {
    const { target, phase } = exercise;
    const pair = this.covered.length > 1;
    const holds = phase === "trial" && kHold.test(exercise.instruction);
    if (this.sign.parentElement !== this.element) this.element.append(this.sign);
    this.sign.style.opacity = holds ? "1" : "0";
    const names = pair || phase !== "trial" ? [] : exercise.choices; // the frame shows the answers of an answer
    if (names.length > 0) this.nameChoices(names);
    this.choosing = eased(this.choosing, names.length > 0 ? 1 : 0, dt, 3);
    this.choices.visible = this.choosing > 0.02;
    this.choices.scale.setScalar(Math.max(0.001, this.choosing));
    this.covered.forEach((one, index) => {
      const active = phase === "trial" && target.kind === "explore" && (!pair || target.sponge === index);
      one.hoop.step(active && names.length === 0, 1, dt, exercise.progress);
      one.shown = eased(one.shown, names.length > 0 ? 0 : 1, dt, 3);
      one.root.visible = one.shown > 0.02;
      one.root.scale.setScalar(Math.max(0.001, one.shown));
    });
  }

  /// The objects that may be the answer, in the order of the station, whichever is in the hand.
  private nameChoices(names: readonly string[]): void {
    const named = names.join("\n");
    if (named === this.named) return;
    this.named = named;
    dispose(this.choices);
    this.choices.clear();
    const apart = Math.min(2.1, 6 / names.length);
    names.forEach((name, at) => {
      const one = new Group();
      const stones = pebbles(at + 1);
      stones.position.set(0, 0.1, 1.1);
      one.add(object(name), stones);
      one.position.x = (at - (names.length - 1) / 2) * apart;
      this.choices.add(one);
    });
  }
}

export const makeFeel: MakeGame = (parts) => new FeelGame(parts);
