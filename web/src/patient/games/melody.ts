// SPDX-License-Identifier: Apache-2.0
// Melody: one finger, one note. Five bells hang from a branch, in the order of the digits. The bell of the instructed finger has a hoop. It
// rings when this finger bends (independence), or when the thumb reaches it (opposition). The melody that has been played swims on the lake
// as lights. Other fingers move their own bells without a sound: to be seen, not to be judged.
import { CatmullRomCurve3, CylinderGeometry, Group, LatheGeometry, Mesh, MeshBasicMaterial, SphereGeometry, TubeGeometry, Vector2, Vector3 } from "three";
import { ChangeWatch } from "../changes";
import { makeDemonstration } from "../demonstration";
import type { ExerciseNow, Free, GameParts, MakeGame } from "../game";
import { LakeGame, kShift } from "./lake_game";
import { Hoop, bead, bounded, eased, finite, glow, kPaper, solid } from "./marks";

const kApart = 1.18; // of two bells [m]
const kBent = 0.5; // flexion at which a bell rings, above where its finger was at rest
const kStraight = 0.28; // it can ring again below this
const kTouch = 0.015; // distance of two pads that touch [m]
const kLoose = 0.03; // it can ring again beyond this [m]
const kFar = 0.09; // distance from which on the light is at the thumb's bell [m]
const kMostLights = 30;
const kBells = { width: 6.3, height: 5.3, middle: 2.35 }; // region of bells and lights
const kWithHand = { width: 6.3, height: 7.9, middle: 1.05 }; // the drawn hand is below them

/// Tells when a movement reaches a place, once for each time that it comes from outside.
export class Crossing {
  private armed = true;

  constructor(private readonly reached: (value: number) => boolean, private readonly away: (value: number) => boolean) {}

  take(value: number | undefined): boolean {
    if (value === undefined || !Number.isFinite(value)) return false;
    if (this.armed && this.reached(value)) {
      this.armed = false;
      return true;
    }
    if (this.away(value)) this.armed = true;
    return false;
  }
}

interface Bell {
  readonly swing: Group; // turns about its hook
  readonly light: ReturnType<typeof glow>;
  readonly hook: Vector3;
  readonly length: number;
  readonly bent: Crossing;
  flexion: number;
  struck: number; // 1 at the stroke, fades
  ringing: number; // follows it
}

function bell(size: number, length: number): Group {
  const swing = new Group();
  const cord = new Mesh(new CylinderGeometry(0.012, 0.012, length, 5), new MeshBasicMaterial({ color: "#e9dcc4" }));
  cord.position.y = -length / 2;
  const shell = new Mesh(
    new LatheGeometry([[0.001, 0.02], [0.1, 0], [0.2, -0.1], [0.26, -0.3], [0.3, -0.55], [0.4, -0.72], [0.43, -0.78], [0.38, -0.77], [0.25, -0.5], [0.18, -0.2], [0.001, -0.05]].map(([x, y]) => new Vector2(x! * size, y! * size)), 36),
    solid("#d9a14e", 0.22),
  );
  shell.material.metalness = 0.45;
  shell.material.roughness = 0.38;
  shell.position.y = -length;
  const clapper = new Mesh(new SphereGeometry(0.09 * size, 14, 10), solid("#8c5a26", 0.15));
  clapper.position.y = -length - 0.84 * size;
  swing.add(cord, shell, clapper);
  return swing;
}

class MelodyGame extends LakeGame {
  private readonly watch = new ChangeWatch();
  private readonly bells: Bell[] = [];
  private readonly hoop = new Hoop(0.66, true, kPaper, 12);
  private readonly spark = bead(0.11, "#fff2b8");
  private readonly sparkLight = glow("#fff0b0", 1.5, 0.9);
  private readonly lights: { readonly root: Group; shown: number }[] = [];
  private readonly touch = new Crossing((distance) => distance <= kTouch, (distance) => distance > kLoose);
  private played: number[] = []; // digits whose trials have ended
  private trialDigit = -1;
  private rang = false; // in this trial
  private side = "right";
  private readonly hand = makeDemonstration(() => this.parts.options.calm);

  constructor(parts: GameParts) {
    super(parts, 1, kBells);
    this.hand.element.style.cssText = "position:absolute;opacity:0;transition:opacity .4s";
    this.element.append(this.hand.element);
  }

  /// The drawn hand stands beside the bells: on its own side, or towards the middle if the cues are on one side. On a narrow page it is below.
  override size(width: number, height: number, free: Free): void {
    const { cues, aphasia } = this.parts.options;
    const beside = !aphasia && free.width > 2 * free.height;
    this.region = beside || aphasia ? kBells : kWithHand; // in aphasia mode the page has the drawn hand itself
    super.size(width, height, free);
    const room = cues === "centre" || width < height ? free.width : (1 - 2 * kShift) * width;
    const perMetre = Math.min(room / this.region.width, free.height / this.region.height);
    const shift = cues === "centre" || width < height ? 0 : (cues === "left" ? -1 : 1) * kShift * width;
    const side = cues === "right" || (cues === "centre" && this.side === "left") ? -1 : 1;
    const edge = beside ? Math.min(3.4 * perMetre, free.width / 2 - side * shift - 3.3 * perMetre) : 2.7 * perMetre;
    const middle = free.left + free.width / 2 + shift + (beside ? side * (3.1 * perMetre + edge / 2) : 0);
    const top = free.top + free.height - edge - (beside ? 0.9 * perMetre : 0);
    Object.assign(this.hand.element.style, { left: `${middle - edge / 2}px`, top: `${top}px`, width: `${edge}px`, height: `${edge}px` });
  }

  protected build(exercise: ExerciseNow): void {
    this.side = exercise.side;
    const curve = new CatmullRomCurve3([new Vector3(-9, 4.6, -0.6), new Vector3(-3.6, 4.62, 0), new Vector3(0, 4.95, 0), new Vector3(3.6, 4.6, 0), new Vector3(9, 5.3, -0.8)]);
    this.scene.add(new Mesh(new TubeGeometry(curve, 60, 0.075, 8), solid("#3d2b2f", 0.05)));
    for (let leaf = 0; leaf < 34; ++leaf) {
      const at = curve.getPoint(0.2 + 0.6 * (leaf / 33));
      const blade = new Mesh(new SphereGeometry(0.15, 10, 6), solid(leaf % 3 === 0 ? "#6f8f5d" : "#4f7050", 0.08));
      blade.scale.set(1.3, 0.4, 0.7);
      blade.position.set(at.x + 0.1 * Math.sin(leaf * 7), at.y + 0.13 * Math.cos(leaf * 5) + 0.06, at.z + 0.1 * Math.sin(leaf * 3));
      blade.rotation.z = 1.2 * Math.sin(leaf * 11);
      this.scene.add(blade);
    }
    for (let digit = 0; digit < 5; ++digit) {
      const place = exercise.side === "left" ? digit - 2 : 2 - digit; // as the drawn hand: the thumb of a right hand is to the right
      const hook = new Vector3(place * kApart, 4.72 - 0.05 * Math.abs(place), 0);
      const size = 1.12 - 0.07 * digit;
      const length = 1.35 + 0.2 * (2 - Math.abs(place));
      const swing = bell(size, length);
      swing.position.copy(hook);
      const light = glow("#ffe3a0", 2.2, 0);
      if (light) this.scene.add(light);
      this.scene.add(swing);
      this.bells.push({ swing, light, hook, length: length + 0.45 * size, flexion: 0, struck: 0, ringing: 0, bent: new Crossing((share) => share >= kBent, (share) => share < kStraight) });
    }
    if (this.sparkLight) this.spark.add(this.sparkLight);
    this.spark.visible = false;
    this.scene.add(this.hoop.root, this.spark);
    const count = Math.min(kMostLights, Math.max(1, exercise.trials));
    for (let at = 0; at < count; ++at) {
      const root = new Group();
      const cup = new Mesh(new CylinderGeometry(0.16, 0.1, 0.09, 18), solid("#f3d7c4", 0.25));
      const flame = bead(0.07, "#ffcf6b");
      flame.position.y = 0.12;
      const shine = glow("#ffd9a0", 0.85, 0.75);
      root.add(cup, flame);
      if (shine) {
        shine.position.y = 0.1;
        root.add(shine);
      }
      root.position.set((count === 1 ? 0 : at / (count - 1) - 0.5) * Math.min(5.6, 0.62 * count), 0.03, -0.8);
      root.visible = false;
      this.lights.push({ root, shown: 0 });
      this.scene.add(root);
    }
  }

  protected update(exercise: ExerciseNow, dt: number): void {
    const { target, flexion } = exercise;
    const touches = exercise.measure === "opposition";
    const asked = target.digits.find((digit) => digit > 0 || !touches) ?? -1;
    const changes = this.watch.take(exercise);
    // The message that ends a trial has another target already.
    if (changes.trialEnded && this.trialDigit >= 0 && this.rang) this.played.push(this.trialDigit);
    if (changes.trialBegan) this.rang = false;
    if (exercise.phase === "trial") this.trialDigit = asked;
    const active = exercise.phase === "trial" && asked >= 0;
    this.moveBells(flexion, dt);
    if (active && touches && this.touch.take(exercise.padDistance[asked - 1])) this.ring(asked);
    this.bells.forEach((one, digit) => {
      if (one.bent.take(flexion[digit]) && active && !touches && digit === asked && target.kind === "close") this.ring(digit);
    });
    this.showHoop(active ? asked : -1, touches, exercise, dt);
    const shows = active && !this.parts.options.aphasia;
    this.hand.element.style.opacity = shows ? "1" : "0";
    if (shows) this.hand.show(exercise, dt, false);
    this.showSpark(active && touches ? finite(exercise.padDistance[asked - 1], kFar) : undefined, asked);
    this.lights.forEach((light, at) => {
      light.shown = eased(light.shown, at < this.played.length ? 1 : 0, dt, 2);
      light.root.visible = light.shown > 0.02;
      light.root.scale.setScalar(Math.max(0.001, 1.7 * light.shown));
      light.root.position.y = 0.04 + 0.085 * (this.played[at] ?? 0) + (this.parts.options.calm ? 0 : 0.012 * Math.sin(this.time + at));
    });
  }

  private ring(digit: number): void {
    this.rang = true;
    this.bells[digit]!.struck = 1;
    this.parts.sound.note(digit, 0.8);
  }

  private moveBells(flexion: readonly number[], dt: number): void {
    this.bells.forEach((one, digit) => {
      one.flexion = eased(one.flexion, bounded(finite(flexion[digit], one.flexion)), dt, 12);
      one.struck = eased(one.struck, 0, dt, 1.1);
      one.ringing = eased(one.ringing, one.struck, dt);
      const sway = this.parts.options.calm ? 0 : 0.03 * Math.sin(0.7 * this.time + digit * 1.3) + 0.2 * one.ringing * Math.sin(5 * this.time);
      one.swing.rotation.z = sway;
      one.swing.rotation.x = -0.5 * one.flexion; // away from the viewer, as a finger that bends
      one.swing.position.y = one.hook.y + 0.5 * one.flexion; // and upwards, which is seen from the front
      if (!one.light) return;
      one.light.position.set(one.hook.x, one.swing.position.y - one.length, -0.3);
      one.light.material.opacity = 0.9 * one.ringing;
    });
  }

  private showHoop(asked: number, touches: boolean, exercise: ExerciseNow, dt: number): void {
    const one = this.bells[asked];
    if (one) this.hoop.root.position.set(one.hook.x, one.hook.y + (touches || exercise.target.kind !== "close" ? 0 : 0.5) - one.length, 0.45);
    const reached = !one ? 0 : touches ? 1 - finite(exercise.padDistance[asked - 1], kFar) / kFar : exercise.target.kind === "close" ? one.flexion / (kBent + 0.2) : 1 - one.flexion / kBent;
    this.hoop.root.scale.setScalar(1 + 0.2 * (one?.ringing ?? 0));
    this.hoop.step(one !== undefined, reached, dt);
  }

  /// The light that the thumb brings to the finger's bell.
  private showSpark(distance: number | undefined, asked: number): void {
    const to = this.bells[asked];
    const from = this.bells[0];
    this.spark.visible = distance !== undefined && to !== undefined;
    if (!this.spark.visible || !to || !from) return;
    const way = bounded(1 - (distance! - kTouch) / (kFar - kTouch));
    const [a, b] = [from, to].map((one) => new Vector3(one.hook.x, one.swing.position.y - one.length, 0.7)) as [Vector3, Vector3];
    this.spark.position.lerpVectors(a, b, way);
    this.spark.position.y -= 0.9 * Math.sin(Math.PI * way);
  }
}

export const makeMelody: MakeGame = (parts) => new MelodyGame(parts);
