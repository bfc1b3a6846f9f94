// SPDX-License-Identifier: Apache-2.0
// Goals of forces. A balloon rises with the force into a gate of two hoops (press and hold, force tracking), a fountain rises (squeeze and
// release, own force), a bubble between two fingertips has a ring that widens (pinch). Nothing falls, breaks or counts against the patient.
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  Color,
  CylinderGeometry,
  DoubleSide,
  Group,
  LatheGeometry,
  Mesh,
  MeshBasicMaterial,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  Points,
  PointsMaterial,
  RingGeometry,
  SphereGeometry,
  TorusGeometry,
  Vector2,
} from "three";
import type { ExerciseNow, GameParts, MakeGame } from "../game";
import { forceTop, nearness } from "./force_scale";
import { LakeGame } from "./lake_game";
import { Hoop, Mirrored, bounded, eased, finite, glow, kGold, kInk, kLightPace, kPaper, sequence, shine, solid } from "./marks";

const kFollow = 14; // [1/s] of what shows a force

/// A hot-air balloon, its basket's floor at 0.
function balloon(): Group {
  const group = new Group();
  const profile = Array.from({ length: 25 }, (_, at) => {
    const t = at / 24;
    const radius = t < 0.62 ? 0.2 + 0.68 * Math.sin((t / 0.62) * (Math.PI / 2)) ** 1.15 : 0.88 * Math.cos(((t - 0.62) / 0.38) * (Math.PI / 2)) ** 0.9;
    return new Vector2(Math.max(0.001, radius), 0.72 + 1.75 * t);
  });
  const skin = new LatheGeometry(profile, 48);
  const places = skin.getAttribute("position");
  const colours: number[] = [];
  const tones = [new Color("#fff3dc"), new Color("#e2725b"), new Color("#fff3dc"), new Color("#f2b56b")];
  for (let at = 0; at < places.count; ++at) {
    const angle = Math.atan2(places.getZ(at), places.getX(at)) + Math.PI;
    const tone = tones[Math.floor((angle / (2 * Math.PI)) * 16 + 0.5) % 4]!;
    colours.push(tone.r, tone.g, tone.b);
  }
  skin.setAttribute("color", new BufferAttribute(new Float32Array(colours), 3));
  group.add(new Mesh(skin, new MeshStandardMaterial({ vertexColors: true, roughness: 0.7, side: DoubleSide, emissive: "#5a3018", emissiveIntensity: 0.35 })));
  const basket = new Mesh(new CylinderGeometry(0.19, 0.16, 0.26, 16), solid("#8a5a34", 0.1));
  basket.position.y = 0.13;
  const rim = new Mesh(new TorusGeometry(0.19, 0.028, 8, 24).rotateX(Math.PI / 2), solid("#5c3a20", 0.1));
  rim.position.y = 0.26;
  group.add(basket, rim);
  for (const side of [-1, 1]) for (const depth of [-1, 1]) {
    const rope = new Mesh(new CylinderGeometry(0.011, 0.011, 0.5, 5), new MeshBasicMaterial({ color: "#5c3a20" }));
    rope.position.set(side * 0.15, 0.5, depth * 0.12);
    rope.rotation.z = side * -0.1;
    group.add(rope);
  }
  return group;
}

const kFloor = 0.35; // of the balloon's way [m]
const kWay = 3.3; // [m]
const kBody = 1.55; // of the balloon: its widest place over its basket [m]

class BalloonGoal extends LakeGame {
  private readonly vessel = balloon();
  private readonly mirrored = new Mirrored(this.vessel);
  private readonly low = new Hoop(1.32, false);
  private readonly high = new Hoop(1.32, false);
  private readonly veil = new Mesh(new CylinderGeometry(1.32, 1.32, 1, 48, 1, true), new MeshBasicMaterial({ color: kPaper, transparent: true, opacity: 0, side: DoubleSide, depthWrite: false, toneMapped: false }));
  private readonly light = glow("#ffe1a1", 4.4, 0);
  private top = 1;
  private force = 0;
  private inside = 0;
  private band: { low: number; high: number } = { low: 0, high: 0 };
  private present = 0;

  constructor(parts: GameParts) {
    super(parts, 0.12, { width: 4.4, height: 6.5, middle: 2.75 });
  }

  protected build(): void {
    this.veil.renderOrder = 2;
    this.scene.add(this.vessel, this.mirrored.root, this.veil, this.low.root, this.high.root);
    if (this.light) this.scene.add(this.light);
    const jetty = new Mesh(new CylinderGeometry(0.62, 0.68, 0.3, 32), solid("#7d6a58", 0.05));
    jetty.position.y = 0.12;
    this.scene.add(jetty);
  }

  protected update(exercise: ExerciseNow, dt: number): void {
    const { target } = exercise;
    const wanted = target.kind === "force" && target.high > 0;
    this.top = forceTop(this.top, exercise);
    this.force = eased(this.force, Math.max(0, finite(exercise.value)), dt, kFollow);
    if (wanted) this.band = { low: target.low, high: target.high };
    this.present = eased(this.present, wanted ? 1 : 0, dt);
    this.inside = eased(this.inside, wanted && exercise.value !== undefined ? nearness(this.force, target.low, target.high) ** 3 : 0, dt);
    const height = (force: number) => kFloor + kWay * Math.min(1.12, force / this.top);
    const sway = this.parts.options.calm ? 0 : 1;
    this.vessel.position.set(0.05 * sway * Math.sin(0.5 * this.time), height(this.force) + 0.012 * sway * Math.sin(0.9 * this.time), 0);
    this.vessel.rotation.y = 0.25 * sway * Math.sin(0.12 * this.time);
    this.mirrored.follow();
    const [low, high] = [height(this.band.low) + kBody, height(this.band.high) + kBody];
    this.low.root.position.y = low;
    this.high.root.position.y = high;
    this.low.step(wanted, this.inside, dt);
    this.high.step(wanted, this.inside, dt);
    this.veil.visible = this.present > 0.02;
    this.veil.position.y = (low + high) / 2;
    this.veil.scale.y = Math.max(0.01, high - low);
    this.veil.material.opacity = this.present * (0.3 + 0.25 * this.inside);
    this.light?.position.set(0, this.vessel.position.y + kBody, -0.4);
    shine(this.light, 0.75 * this.inside, dt);
  }
}

const kDrops = 260;
const kHighest = 4.6; // of the fountain [m]
const kTypical = 6; // force whose fountain has 63 % of it [N]

/// Height of the fountain. It has no end of scale: a strong hand always moves it, and a weak one does so clearly. @param force  [N]
export const fountainHeight = (force: number) => kHighest * (1 - Math.exp(-Math.max(0, force) / kTypical));

class FountainGoal extends LakeGame {
  private readonly drops: Points<BufferGeometry, PointsMaterial>;
  private readonly seeds: { turn: number; at: number; wide: number }[] = [];
  private readonly peak = new Hoop(0.95, false, kPaper, 8);
  private readonly basin = new Hoop(1.5, false, kPaper, 8, 0.03);
  private readonly column = new Mesh(new CylinderGeometry(0.03, 0.14, 1, 20, 1, true), new MeshBasicMaterial({ color: "#ffffff", transparent: true, opacity: 0.32, depthWrite: false, toneMapped: false }));
  private readonly light = glow("#ffffff", 3, 0.3);
  private force = 0;
  private greatest = 0;
  private spread = 1;

  constructor(parts: GameParts) {
    super(parts, 0.5, { width: 4.6, height: 6.2, middle: 2.75 });
    const random = sequence(31);
    for (let at = 0; at < kDrops; ++at) this.seeds.push({ turn: random() * 2 * Math.PI, at: random(), wide: 0.25 + 0.75 * random() });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(kDrops * 3), 3));
    const spot = this.light?.material.map ?? null;
    this.drops = new Points(geometry, new PointsMaterial({ ...(spot ? { map: spot } : {}), color: "#ffffff", size: 0.3, transparent: true, opacity: 0.8, depthWrite: false, toneMapped: false }));
    this.drops.frustumCulled = false;
    this.drops.renderOrder = 3;
  }

  protected build(): void {
    const bowl = new Mesh(new LatheGeometry([new Vector2(0.001, 0.02), new Vector2(0.7, 0.06), new Vector2(1.12, 0.22), new Vector2(1.22, 0.36), new Vector2(1.16, 0.36), new Vector2(0.9, 0.2), new Vector2(0.001, 0.16)], 56), solid("#c9c3b4", 0.12));
    this.scene.add(bowl, new Mirrored(bowl).root, this.column, this.drops, this.peak.root, this.basin.root);
    if (this.light) this.scene.add(this.light);
    this.column.renderOrder = 3;
    this.basin.root.position.y = 0.06;
  }

  protected update(exercise: ExerciseNow, dt: number): void {
    const squeezes = exercise.target.kind === "squeeze";
    const letsGo = exercise.target.kind === "open";
    this.force = eased(this.force, Math.max(0, finite(exercise.value)), dt, kFollow);
    if (exercise.phase !== "trial") this.greatest = eased(this.greatest, 0, dt, 1.5);
    else this.greatest = Math.max(this.greatest, this.force);
    const height = fountainHeight(this.force);
    // Squeezing gathers the ring at the foot, letting go spreads it: a sign without colour.
    this.spread = eased(this.spread, squeezes ? 0.86 : letsGo ? 1.32 : 1.05, dt);
    this.basin.resize(this.spread);
    this.basin.step(squeezes || letsGo, letsGo ? Math.exp(-this.force / 1.5) : bounded(height / kHighest), dt);
    this.peak.root.position.y = 0.3 + fountainHeight(this.greatest);
    this.peak.step(this.greatest > 0.3, squeezes ? 1 : 0.4, dt);
    this.column.visible = height > 0.03;
    this.column.scale.set(1, Math.max(0.01, height), 1);
    this.column.position.y = 0.3 + height / 2;
    if (this.light) {
      this.light.position.set(0, 0.3 + height, 0);
      this.light.scale.setScalar(eased(this.light.scale.x, 0.6 + 0.4 * height, dt, kLightPace));
    }
    const places = this.drops.geometry.getAttribute("position") as BufferAttribute;
    this.seeds.forEach(({ turn, at, wide }, drop) => {
      const share = (at + (this.parts.options.calm ? 0 : this.time * 0.45)) % 1;
      const out = (0.05 + 0.95 * wide) * (0.35 + 0.24 * height) * share;
      places.setXYZ(drop, out * Math.cos(turn), height < 0.03 ? -1 : 0.32 + height * (0.72 + 0.28 * wide) * Math.max(0, 1 - (1.55 * share - 0.55) ** 2 + (share < 0.355 ? (1.55 * share - 0.55) ** 2 * 0.4 : 0)), out * Math.sin(turn));
    });
    places.needsUpdate = true;
  }
}

const kCentre = 2.9; // of the bubble [m]
const kBubble = 0.86;
const kRingWay = 1.35; // of the ring, from no force to the end of the scale [m]

/// A fingertip as the drawn hand's, whose end is at 0 and which points to -x.
function fingertip(): Group {
  const group = new Group();
  const profile = Array.from({ length: 76 }, (_, at) => {
    const t = at / 29; // beyond 1 the finger goes on, into the water
    const tip = t < 0.18 ? Math.sqrt(1 - (1 - t / 0.18) ** 2) : 1;
    const joint = 0.035 * Math.exp(-(((t - 0.56) / 0.09) ** 2));
    return new Vector2(Math.max(0.001, tip * (0.43 + 0.12 * Math.min(1, t) + joint)), 3.1 * t);
  });
  const shape = new LatheGeometry(profile, 36).rotateZ(-Math.PI / 2);
  const skin = new Mesh(shape, solid("#f8e8d4", 0.1));
  const edge = new Mesh(new LatheGeometry(profile.map(({ x, y }) => new Vector2(x + 0.045, y * 1.012 - 0.04)), 36).rotateZ(-Math.PI / 2), new MeshBasicMaterial({ color: kInk, side: BackSide, toneMapped: false }));
  const nail = new Mesh(new SphereGeometry(0.3, 24, 16), new MeshStandardMaterial({ color: "#fffaf3", roughness: 0.3, emissive: "#e8b9a8", emissiveIntensity: 0.25 }));
  nail.scale.set(1.15, 0.3, 0.78);
  nail.position.set(0.42, 0.36, 0.22);
  nail.rotation.set(0.5, 0, 0.18);
  group.add(edge, skin, nail);
  for (const at of [1.66, 1.78]) {
    const crease = new Mesh(new TorusGeometry(0.53, 0.014, 6, 40).rotateY(Math.PI / 2), new MeshBasicMaterial({ color: "#b98f77", toneMapped: false }));
    crease.position.x = at;
    group.add(crease);
  }
  return group;
}

const kSlope = 0.42; // of the fingertips to the water [rad]

class PinchGoal extends LakeGame {
  private readonly bubble = new Mesh(new SphereGeometry(kBubble, 40, 28), new MeshPhysicalMaterial({ color: "#bfe3ee", roughness: 0.12, transparent: true, opacity: 0.72, iridescence: 0.9, clearcoat: 1 }));
  private readonly tips = [fingertip(), fingertip()] as const; // thumb, finger
  private readonly ring = new Mesh(new TorusGeometry(1, 0.045, 12, 96), solid(kGold, 0.55));
  private readonly inner = new Hoop(1, true, kPaper, 16, 0.025);
  private readonly outer = new Hoop(1, true, kPaper, 16, 0.025);
  private readonly light = glow("#ffe9b8", 5, 0);
  private veil: Mesh<RingGeometry, MeshBasicMaterial> | undefined;
  private band = "";
  private top = 1;
  private force = 0;
  private inside = 0;
  private readonly gaps = [0.5, 0.5];
  private thumbSide = 1;

  constructor(parts: GameParts) {
    super(parts, 0.06, { width: 5.6, height: 5.6, middle: kCentre });
  }

  protected build(exercise: ExerciseNow): void {
    this.thumbSide = exercise.side === "left" ? -1 : 1; // as the drawn hand
    this.tips.forEach((tip, at) => {
      const side = at === 0 ? this.thumbSide : -this.thumbSide;
      tip.rotation.z = -kSlope * side;
      tip.scale.setScalar(at === 0 ? 1.12 : 1);
      tip.scale.x *= side;
      this.scene.add(tip);
    });
    this.bubble.position.y = kCentre;
    const edge = new Mesh(new TorusGeometry(1, 0.07, 10, 96), new MeshBasicMaterial({ color: kInk, toneMapped: false }));
    edge.position.z = -0.04;
    this.ring.add(edge);
    this.ring.position.set(0, kCentre, 0.9);
    for (const hoop of [this.inner, this.outer]) hoop.root.position.set(0, kCentre, 0.8);
    if (this.light) {
      this.light.position.set(0, kCentre, -0.6);
      this.scene.add(this.light);
    }
    this.scene.add(this.bubble, this.ring, this.inner.root, this.outer.root);
  }

  protected update(exercise: ExerciseNow, dt: number): void {
    const { target } = exercise;
    const wanted = target.kind === "force" && target.high > 0;
    this.top = forceTop(this.top, exercise);
    this.force = eased(this.force, Math.max(0, finite(exercise.value)), dt, kFollow);
    const radius = (force: number) => kBubble + 0.12 + kRingWay * Math.min(1.1, force / this.top);
    if (wanted) this.setBand(radius(target.low), radius(target.high));
    this.inside = eased(this.inside, wanted && exercise.value !== undefined ? nearness(this.force, target.low, target.high) ** 3 : 0, dt);
    this.inner.step(wanted, this.inside, dt);
    this.outer.step(wanted, this.inside, dt);
    if (this.veil) this.veil.material.opacity = eased(this.veil.material.opacity, wanted ? 0.26 + 0.25 * this.inside : 0, dt);
    this.ring.scale.set(radius(this.force), radius(this.force), 1);
    shine(this.light, 0.7 * this.inside, dt);
    const finger = target.digits.find((digit) => digit > 0) ?? 1;
    [0, finger].forEach((digit, at) => {
      const touches = exercise.touching[digit] === true || finite(exercise.force[digit]) > 0.05;
      this.gaps[at] = eased(this.gaps[at]!, touches ? -0.07 - 0.05 * bounded(finite(exercise.force[digit]) / 4) : 0.42, dt, 6);
      const tip = this.tips[at]!;
      const side = at === 0 ? this.thumbSide : -this.thumbSide;
      const away = kBubble + this.gaps[at]!;
      tip.position.set(side * away * Math.cos(kSlope), kCentre - away * Math.sin(kSlope), 0);
    });
    const squeezed = bounded(this.force / Math.max(1, this.top)) * 0.1;
    this.bubble.scale.set(1 - squeezed, 1 + squeezed * 0.6, 1 + squeezed * 0.6);
    if (!this.parts.options.calm) this.bubble.rotation.z = 0.2 * Math.sin(0.4 * this.time);
  }

  private setBand(inner: number, outer: number): void {
    const band = `${inner.toFixed(2)} ${outer.toFixed(2)}`;
    if (band === this.band) return;
    this.band = band;
    this.inner.resize(inner);
    this.outer.resize(outer);
    if (this.veil) {
      this.scene.remove(this.veil);
      this.veil.geometry.dispose();
      this.veil.material.dispose();
    }
    this.veil = new Mesh(new RingGeometry(inner, outer, 96), new MeshBasicMaterial({ color: kPaper, transparent: true, opacity: 0.26, depthWrite: false, toneMapped: false }));
    this.veil.position.set(0, kCentre, 0.75);
    this.veil.renderOrder = 2;
    this.scene.add(this.veil);
  }
}

export const makeBalloon: MakeGame = (parts) => new BalloonGoal(parts);
export const makeFountain: MakeGame = (parts) => new FountainGoal(parts);
export const makePinch: MakeGame = (parts) => new PinchGoal(parts);
