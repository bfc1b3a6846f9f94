// SPDX-License-Identifier: Apache-2.0
// The river: force steers a boat sideways, and the target is a lane of light on the water. A quick squeeze fills the sail instead. Nothing is
// lost or taken away: outside of the lane the boat goes on as well.
import { DirectionalLight, Fog, HemisphereLight, PerspectiveCamera, Scene, Vector3 } from "three";
import type { ExerciseNow, Free, Game, GameParts } from "../game";
import { World } from "../world";
import { forceTop } from "./force_scale";
import { PlainGoal } from "./plain_goal";
import { Banks, kHalfWidth } from "./river_banks";
import { Boat } from "./river_boat";
import { RiverLights } from "./river_lights";
import { Wake } from "./river_wake";

const kSpeed = 1.9; // of the water in a trial [m/s]
const kRestSpeed = 0.9;
const kCalm = 0.3; // of both with less motion
const kWide = 3.3; // largest way of the boat to each side of the middle [m]
const kShare = 0.7; // of what is visible beside the middle
const kBoatPlace = 0.7; // of the boat, down the free part of the page
const kSteer = 0.1; // time constant of the boat [s]
const kGlide = 0.8; // over which the lane ahead goes on as it moves now [s]
const kDayBegin = 0.08;
const kDayEnd = 0.92;
const kLeastTop = 1; // [N]
const kLeap = 3; // of the boat in a squeeze, ahead [m]
const kNoteGap = 1.5; // between two notes [s]
const kKept = 40; // points of the lane that lie behind
const kKeptSpacing = 0.15; // [m]

const total = (values: readonly number[]) => values.reduce((sum, value) => sum + (Number.isFinite(value) ? value : 0), 0);
const towards = (now: number, goal: number, dt: number, constant: number) => now + (goal - now) * (1 - Math.exp(-dt / constant));

class River implements Game {
  readonly element = document.createElement("div");
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(44, 1, 0.1, 700);
  private readonly world = new World(kHalfWidth);
  private readonly fog = new Fog("#f3dfcf", 16, 120);
  private readonly sun = new DirectionalLight("#ffffff", 2.6);
  private readonly heaven = new HemisphereLight("#e8f2ff", "#8a9a76", 1.9);
  private readonly fill = new DirectionalLight("#dfeaf5", 0.9);
  private readonly banks = new Banks();
  private readonly lights = new RiverLights();
  private readonly wake = new Wake();
  private readonly plain = new PlainGoal();
  private boat: Boat | undefined;
  private time = 0;
  private travel = 0;
  private speed = kRestSpeed;
  private reach = kWide;
  private top = kLeastTop;
  private x: number | undefined;
  private z = 0;
  private sideways = 0; // [m/s]
  private wind = 0.3;
  private lane = { x: 0, half: 0.6, speed: 0 };
  private readonly behind: { travel: number; x: number; half: number }[] = []; // the newest first
  private day = kDayBegin;
  private wasInside = false;
  private sinceNote = kNoteGap;

  constructor(private readonly parts: GameParts) {
    this.element.className = "river";
    this.scene.add(this.world.sky, this.world.water, this.heaven, this.sun, this.sun.target, this.fill, this.banks.group, this.lights.group, this.wake.mesh);
    this.scene.fog = this.fog;
    this.fill.position.set(-3, 6, 8);
  }

  begin(exercise: ExerciseNow): void {
    this.boat = new Boat(exercise.symbol);
    this.scene.add(this.boat.group);
    const lanterns = this.lanterns(exercise);
    while (this.lights.risen < lanterns) this.lights.rise(this.lights.risen + 1, new Vector3(), true);
    this.day = this.dayOf(exercise);
  }

  size(width: number, height: number, free: Free): void {
    const aspect = width / Math.max(1, height);
    const { camera } = this;
    camera.aspect = aspect;
    camera.fov = aspect >= 1 ? 44 : 58;
    camera.position.set(0, aspect >= 1 ? 2.9 : 3.9, aspect >= 1 ? 8.8 : 11.4);
    camera.lookAt(0, 1.1, -7);
    camera.clearViewOffset();
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    const boat = new Vector3(0, 0.6, 0).project(camera);
    const place = ((1 - boat.y) / 2) * height;
    const wanted = free.top + kBoatPlace * free.height;
    camera.setViewOffset(width, height, 0, place - wanted, width, height);
    const half = camera.position.z * Math.tan((camera.fov * Math.PI) / 360) * aspect * (free.width / Math.max(1, width));
    this.reach = Math.min(kWide, kShare * half);
  }

  show(exercise: ExerciseNow, dt: number): void {
    const { options, stage } = this.parts;
    this.top = forceTop(this.top, exercise);
    if (!stage.able) {
      if (!this.plain.element.isConnected) this.element.replaceChildren(this.plain.element);
      this.plain.show(exercise, options);
      return;
    }
    this.plain.element.remove();
    const { target } = exercise;
    const steers = target.kind === "force";
    const squeezes = exercise.measure === "squeeze_release";
    const trial = exercise.phase === "trial";
    const value = exercise.value ?? total(exercise.force);
    if (squeezes) this.top = Math.max(this.top, value);
    const share = Math.min(1.1, Math.max(0, value / this.top));

    // The river and the time of day.
    const calm = options.calm ? kCalm : 1;
    const wanted = (trial ? kSpeed : kRestSpeed) + (squeezes && trial ? 3 * share : 0);
    this.speed = towards(this.speed, wanted * calm, dt, 0.6);
    this.time += dt * (options.calm ? kCalm : 1);
    this.travel += dt * this.speed;
    this.day = towards(this.day, this.dayOf(exercise), dt, 3);
    this.light(options.contrast);

    // The boat.
    const goal = squeezes ? 0 : this.placeOf(value);
    const before = this.x ?? goal;
    this.x = towards(before, goal, dt, kSteer);
    if (dt > 0) this.sideways = towards(this.sideways, (this.x - before) / dt, dt, 0.15);
    this.z = towards(this.z, squeezes ? -kLeap * share : 0, dt, 0.25);
    this.wind = towards(this.wind, 0.25 + 0.75 * Math.min(1, share), dt, 0.2);
    const sway = options.calm ? 0.2 : 1;
    const lean = Math.max(-0.28, Math.min(0.28, -0.09 * this.sideways));
    this.boat?.fill(this.wind, 5 * this.time);
    this.boat?.place(
      this.x, 0.02 + 0.035 * sway * Math.sin(1.5 * this.time), this.z, lean + 0.03 * sway * Math.sin(1.1 * this.time),
      Math.max(-0.35, Math.min(0.35, -0.12 * this.sideways)), 0.025 * sway * Math.sin(1.3 * this.time) + 0.05 * (squeezes ? share : 0),
    );
    this.wake.show(this.x, this.z + 1, this.travel, this.speed);

    // The lane.
    const inside = steers && trial && value >= target.low && value <= target.high;
    if (steers) this.follow(this.placeOf((target.low + target.high) / 2), Math.max(0.45, ((target.high - target.low) / 2 / this.top) * 2 * this.reach), dt);
    this.lights.show((z) => this.laneAt(z), steers && trial, inside, 0, this.travel, this.time, dt, options.contrast);
    this.sing(inside, squeezes && trial && target.kind === "squeeze" && share > 0.3, dt);
    if (this.lanterns(exercise) > this.lights.risen) this.lights.rise(this.lights.risen + 1, new Vector3(this.x, 1.2, this.z));
    stage.draw(this.scene, this.camera);
  }

  end(): void {
    for (const one of [this.world, this.banks, this.lights, this.wake, this.boat]) one?.dispose();
    for (const one of [this.sun, this.heaven, this.fill]) one.dispose();
  }

  /// Sideways place of a force.
  private placeOf(force: number): number {
    return this.reach * (2 * Math.min(1.05, Math.max(0, force / this.top)) - 1);
  }

  /// Of trainings the successes, of assessments the trials that are over: what rises says nothing else.
  private lanterns({ training, successes, trial, phase }: ExerciseNow): number {
    return training ? successes : Math.max(0, phase === "done" ? trial : trial - 1);
  }

  private dayOf({ trial, trials, progress, phase }: ExerciseNow): number {
    const done = trials > 0 ? (Math.max(0, trial - 1) + (phase === "trial" ? progress : 0)) / trials : 0;
    return kDayBegin + (kDayEnd - kDayBegin) * Math.min(1, done);
  }

  private light(contrast: boolean): void {
    const { world } = this;
    world.setDay(this.day, contrast);
    world.move(this.time, this.travel, 1);
    this.fog.color.copy(world.mist);
    this.sun.color.copy(world.sunColour);
    this.sun.position.copy(world.towards).multiplyScalar(30);
    this.sun.position.y += 9;
    this.banks.group.visible = !contrast;
    this.banks.move(this.travel);
  }

  private follow(x: number, half: number, dt: number): void {
    const { lane } = this;
    if (this.behind.length === 0) Object.assign(lane, { x, half, speed: 0 });
    const before = lane.x;
    lane.x = towards(lane.x, x, dt, 0.05);
    lane.half = towards(lane.half, half, dt, 0.4);
    if (dt > 0) lane.speed = towards(lane.speed, (lane.x - before) / dt, dt, 0.2);
    const newest = this.behind[0];
    if (newest && this.travel - newest.travel < kKeptSpacing) return;
    this.behind.unshift({ travel: this.travel, x: lane.x, half: lane.half });
    if (this.behind.length > kKept) this.behind.pop();
  }

  private laneAt(z: number): { x: number; half: number } {
    const { lane } = this;
    if (z <= 0) {
      const ahead = -z / Math.max(0.3, this.speed); // [s]
      return { x: lane.x + lane.speed * kGlide * (1 - Math.exp(-ahead / kGlide)), half: lane.half };
    }
    let newer = { travel: this.travel, x: lane.x, half: lane.half };
    for (const older of this.behind) {
      if (this.travel - older.travel >= z) {
        const share = (this.travel - newer.travel - z) / Math.min(-1e-6, older.travel - newer.travel);
        return { x: newer.x + (older.x - newer.x) * Math.min(1, Math.max(0, share)), half: newer.half };
      }
      newer = older;
    }
    return newer;
  }

  /// A soft note when the boat comes into the light, or the sail fills.
  private sing(inside: boolean, filled: boolean, dt: number): void {
    this.sinceNote += dt;
    const now = inside || filled;
    if (now && !this.wasInside && this.sinceNote > kNoteGap) {
      this.parts.sound.note(filled ? 0 : 2, 0.45);
      this.sinceNote = 0;
    }
    this.wasInside = now;
  }
}

export const river = (parts: GameParts): Game => new River(parts);
