// SPDX-License-Identifier: Apache-2.0
// The cameras: the main one, moved by mouse and touch, by keys, by presets, and after the contact; and those of further views, which
// stand at a preset.
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { between, inPicture, orbited, placeFor, wholePicture, worldUp } from "./camera_presets";
import type { CameraPlace, FreePart, Sight } from "./camera_presets";
import type { CameraPreset } from "./hand_view";

const kFieldOfView = 30; // vertical [deg]
const kNearest = 0.04; // [m]
const kFarthest = 3;
const kFlight = 0.4; // to a preset [s]
const kFollowTime = 0.3; // [s]
const kRest = 1; // [s] between two corrections of a preset
const kLeave: FreePart = { left: -0.97, right: 0.97, bottom: -0.97, top: 0.97 }; // a hand that goes beyond is about to leave the picture

function madeCamera(): PerspectiveCamera {
  const camera = new PerspectiveCamera(kFieldOfView, 1, 0.01, 12);
  camera.up.copy(worldUp);
  camera.position.set(-0.3, 0.3, 0.3);
  return camera;
}

function setAspect(camera: PerspectiveCamera, aspect: number): void {
  camera.aspect = aspect;
  camera.updateProjectionMatrix();
}

function fieldOf(camera: PerspectiveCamera): number {
  return (camera.fov * Math.PI) / 180;
}

export class CameraRig {
  readonly camera = madeCamera();
  preset: CameraPreset | null = "home"; // null: moved by hand since
  private readonly controls: OrbitControls;
  private flight: { from: CameraPlace; to: CameraPlace; began: number } | null = null;
  private following = false;
  private byHand = false; // turned or zoomed since the preset was chosen
  private free = wholePicture;
  private corrected = -Infinity; // when the preset was last applied [s]

  /// @param changed  called whenever a new frame is needed
  constructor(surface: HTMLElement, private readonly changed: () => void) {
    this.controls = new OrbitControls(this.camera, surface);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = kNearest;
    this.controls.maxDistance = kFarthest;
    this.controls.zoomSpeed = 1.2;
    this.controls.addEventListener("start", this.grabbed);
    this.controls.addEventListener("change", this.changed);
  }

  get target(): Vector3 {
    return this.controls.target;
  }

  /// @param free  the part of the picture that nothing covers
  setPicture(aspect: number, free: FreePart): void {
    setAspect(this.camera, aspect);
    this.free = free;
  }

  /// @param at  now [s]; null: without a flight
  goTo(preset: CameraPreset, sight: Sight, at: number | null): void {
    const to = placeFor(preset, sight, fieldOf(this.camera), this.camera.aspect, this.free);
    this.preset = preset;
    this.following = preset === "contact";
    this.byHand = false;
    if (at !== null) this.corrected = at;
    if (at === null || reducedMotion()) {
      this.flight = null;
      this.stand(to);
    } else {
      this.flight = { from: this.place(), to, began: at };
    }
    this.changed();
  }

  /// A preset keeps the hand in the picture, wherever it goes. @param hand  where it is now
  keepInPicture(hand: readonly Vector3[], sight: () => Sight, now: number): void {
    if (this.preset === null || this.following || this.flight || now - this.corrected < kRest || this.sees(hand)) return;
    this.goTo(this.preset, sight(), now);
  }

  sees(points: readonly Vector3[]): boolean {
    return inPicture(points, this.place(), fieldOf(this.camera), this.camera.aspect, kLeave);
  }

  zoom(factor: number): void {
    if (!(factor > 0) || !Number.isFinite(factor)) return;
    const place = this.leavePreset();
    const from = place.position.clone().sub(place.target);
    const distance = Math.min(kFarthest, Math.max(kNearest, from.length() / factor));
    this.stand({ target: place.target, position: place.target.clone().addScaledVector(from.normalize(), distance) });
    this.changed();
  }

  orbit(right: number, up: number): void {
    if (!Number.isFinite(right + up)) return;
    this.stand(orbited(this.leavePreset(), right, up));
    this.changed();
  }

  /// Once a frame. @param sight  what a camera that follows the contact sees  @param step  since the last frame [s]
  /// @returns true while the camera moves by itself
  update(now: number, step: number, sight: () => Sight): boolean {
    if (this.flight) {
      const share = Math.min(1, (now - this.flight.began) / kFlight);
      this.stand(between(this.flight.from, this.flight.to, share * share * (3 - 2 * share)));
      if (share >= 1) this.flight = null;
      return this.flight !== null;
    }
    const moved = this.controls.update();
    return this.following ? this.follow(sight(), step) || moved : moved;
  }

  dispose(): void {
    this.controls.dispose();
  }

  /// The target goes to the contact. Direction and distance are the user's; the distance is the preset's until the user has turned or
  /// zoomed, so that a hand that opens stays in the picture.
  private follow(sight: Sight, step: number): boolean {
    const to = placeFor("contact", sight, fieldOf(this.camera), this.camera.aspect, this.free);
    const { position, target } = this.place();
    const from = position.sub(target);
    const distance = from.length();
    const wanted = this.byHand ? distance : to.position.distanceTo(to.target);
    const away = to.target.sub(target);
    if (away.length() < 5e-5 && Math.abs(wanted - distance) < 5e-5) return false;
    const share = 1 - Math.exp(-Math.min(step, 0.1) / kFollowTime);
    target.addScaledVector(away, share);
    this.stand({ target, position: target.clone().addScaledVector(from, (distance + (wanted - distance) * share) / distance) });
    return true;
  }

  private readonly grabbed = (): void => {
    this.leavePreset();
  };

  /// Following continues while the user turns and zooms.
  private leavePreset(): CameraPlace {
    const place = this.place();
    this.flight = null;
    this.preset = this.following ? "contact" : null;
    this.byHand = true;
    return place;
  }

  private place(): CameraPlace {
    return { position: this.camera.position.clone(), target: this.controls.target.clone() };
  }

  private stand(place: CameraPlace): void {
    this.camera.position.copy(place.position);
    this.controls.target.copy(place.target);
    this.camera.lookAt(place.target);
  }
}

/// The camera of a further view: it stands at its preset, and goes after it slowly.
export class FixedCamera {
  readonly camera = madeCamera();
  readonly target = new Vector3();
  private preset: CameraPreset | null = null;

  /// @returns true while it moves
  update(preset: CameraPreset, sight: Sight, aspect: number, free: FreePart, step: number): boolean {
    if (aspect !== this.camera.aspect) setAspect(this.camera, aspect);
    const to = placeFor(preset, sight, fieldOf(this.camera), aspect, free);
    const from = { position: this.camera.position.clone(), target: this.target.clone() };
    const share = preset === this.preset ? 1 - Math.exp(-Math.min(step, 0.1) / kFollowTime) : 1;
    const next = between(from, to, share);
    this.preset = preset;
    this.target.copy(next.target);
    this.camera.position.copy(next.position);
    this.camera.lookAt(this.target);
    return next.position.distanceTo(to.position) > 1e-4;
  }
}

function reducedMotion(): boolean {
  return globalThis.matchMedia?.("(prefers-reduced-motion: reduce)").matches ?? false;
}
