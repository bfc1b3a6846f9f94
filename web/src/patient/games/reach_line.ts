// SPDX-License-Identifier: Apache-2.0
// Goal of one smooth movement: a lantern goes along an arc of stones as the finger bends, to a hoop. Stones that it has passed are larger.
import { CylinderGeometry, Group, LatheGeometry, Mesh, MeshBasicMaterial, MeshStandardMaterial, SphereGeometry, Vector2 } from "three";
import type { ExerciseNow, GameParts, MakeGame } from "../game";
import { LakeGame } from "./lake_game";
import { Hoop, Mirrored, bead, bounded, eased, finite, glow, kPaper, solid } from "./marks";

const kStones = 25;
const kFollow = 16; // [1/s]: the lantern is where the finger is
const kNear = 0.12; // share of the way within which the hoop's beads grow

/// Place on the arc. @param share  0 open .. 1 closed
export function arcAt(share: number): { x: number; y: number } {
  const angle = Math.PI * (0.93 - 0.86 * share);
  return { x: 3 * Math.cos(angle), y: 0.55 + 3.1 * Math.sin(angle) };
}

function lantern(): Group {
  const group = new Group();
  const body = new Mesh(
    new LatheGeometry([[0.001, -0.42], [0.2, -0.42], [0.33, -0.26], [0.38, 0], [0.33, 0.26], [0.2, 0.42], [0.001, 0.42]].map(([x, y]) => new Vector2(x!, y!)), 32),
    new MeshStandardMaterial({ color: "#ffdf9a", roughness: 0.8, emissive: "#ff9d3c", emissiveIntensity: 0.75 }),
  );
  group.add(body);
  for (const y of [-0.42, 0.42]) {
    const cap = new Mesh(new CylinderGeometry(0.21, 0.21, 0.07, 24), solid("#7a3a1c", 0.1));
    cap.position.y = y;
    group.add(cap);
  }
  for (const y of [-0.21, 0, 0.21]) {
    const rib = new Mesh(new CylinderGeometry(0.352 + (y === 0 ? 0.032 : 0), 0.352 + (y === 0 ? 0.032 : 0), 0.014, 32, 1, true), new MeshBasicMaterial({ color: "#b9632c" }));
    rib.position.y = y;
    group.add(rib);
  }
  return group;
}

class ReachGoal extends LakeGame {
  private readonly lantern = lantern();
  private readonly mirrored = new Mirrored(this.lantern, 0.3);
  private readonly light = glow("#ffd08a", 3.4, 0.8);
  private readonly hoop = new Hoop(0.66, true, kPaper, 12);
  private readonly stones: Group[] = [];
  private at = 0;
  private goal = 0;

  constructor(parts: GameParts) {
    super(parts, 0.92, { width: 7.6, height: 5.2, middle: 2.2 });
  }

  protected build(): void {
    for (let stone = 0; stone < kStones; ++stone) {
      const one = bead(0.075, "#dfe9ee");
      const { x, y } = arcAt(stone / (kStones - 1));
      one.position.set(x, y, -0.3);
      this.stones.push(one);
      this.scene.add(one);
    }
    for (const share of [0, 1]) {
      const { x } = arcAt(share);
      const islet = new Mesh(new SphereGeometry(0.85, 28, 12, 0, 2 * Math.PI, 0, Math.PI / 2), solid("#4d6b5a", 0.06));
      islet.scale.set(1.2, 0.42, 0.8);
      islet.position.set(x * 1.03, -0.02, -0.5);
      this.scene.add(islet);
    }
    if (this.light) this.scene.add(this.light);
    this.scene.add(this.lantern, this.mirrored.root, this.hoop.root);
  }

  protected update(exercise: ExerciseNow, dt: number): void {
    const { target } = exercise;
    const digit = target.digits[0] ?? 1;
    this.at = eased(this.at, bounded(finite(exercise.flexion[digit], this.at)), dt, kFollow);
    const wanted = target.kind === "angle" ? target.flexion[digit] : undefined;
    const present = wanted !== undefined && Number.isFinite(wanted);
    if (present) this.goal = eased(this.goal, bounded(wanted), dt, 6);
    const { x, y } = arcAt(this.at);
    this.lantern.position.set(x, y, 0);
    this.lantern.rotation.z = this.parts.options.calm ? 0 : 0.04 * Math.sin(0.9 * this.time);
    this.mirrored.follow();
    this.light?.position.set(x, y, -0.2);
    const goal = arcAt(this.goal);
    this.hoop.root.position.set(goal.x, goal.y, 0.1);
    this.hoop.step(present, 1 - Math.abs(this.at - this.goal) / kNear, dt);
    this.stones.forEach((stone, index) => {
      const passed = index / (kStones - 1) <= this.at;
      const size = eased(stone.scale.x, passed ? 1.35 : 0.75, dt);
      stone.scale.setScalar(size);
    });
  }
}

export const makeReach: MakeGame = (parts) => new ReachGoal(parts);
