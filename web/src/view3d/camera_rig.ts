// SPDX-License-Identifier: Apache-2.0
// The camera: moved by mouse and touch, by keys, by presets, and after the grip.
import { PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { between, orbited, placeFor, worldUp } from "./camera_presets";
import type { CameraPlace, Sight } from "./camera_presets";
import type { CameraPreset } from "./hand_view";

const kFieldOfView = 30; // vertical [deg]
const kNearest = 0.04; // [m]
const kFarthest = 3;
const kFlight = 0.4; // to a preset [s]
const kFollowTime = 0.15; // [s]

export class CameraRig {
  readonly camera = new PerspectiveCamera(kFieldOfView, 1, 0.01, 12);
  preset: CameraPreset | null = "home"; // null: moved by hand since
  private readonly controls: OrbitControls;
  private flight: { from: CameraPlace; to: CameraPlace; began: number } | null = null;
  private following = false;

  /// @param changed  called whenever a new frame is needed
  constructor(surface: HTMLElement, private readonly changed: () => void) {
    this.camera.up.copy(worldUp);
    this.camera.position.set(-0.3, 0.3, 0.3);
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

  setAspect(aspect: number): void {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
  }

  /// @param at  now [s]; null: without a flight
  goTo(preset: CameraPreset, sight: Sight, at: number | null): void {
    const to = placeFor(preset, sight, (this.camera.fov * Math.PI) / 180, this.camera.aspect);
    this.preset = preset;
    this.following = preset === "follow";
    if (at === null || reducedMotion()) {
      this.flight = null;
      this.stand(to);
    } else {
      this.flight = { from: this.place(), to, began: at };
    }
    this.changed();
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

  /// Once a frame. @param grip  what "follow" follows  @param step  since the last frame [s]
  /// @returns true while the camera moves by itself
  update(now: number, step: number, grip: Vector3 | null): boolean {
    if (this.flight) {
      const share = Math.min(1, (now - this.flight.began) / kFlight);
      this.stand(between(this.flight.from, this.flight.to, share * share * (3 - 2 * share)));
      if (share >= 1) this.flight = null;
      return this.flight !== null;
    }
    const moved = this.controls.update();
    return this.following && grip ? this.followGrip(grip, step) || moved : moved;
  }

  dispose(): void {
    this.controls.dispose();
  }

  private followGrip(grip: Vector3, step: number): boolean {
    const away = grip.clone().sub(this.controls.target);
    if (away.length() < 1e-5) return false;
    away.multiplyScalar(1 - Math.exp(-Math.min(step, 0.1) / kFollowTime));
    this.controls.target.add(away);
    this.camera.position.add(away);
    return true;
  }

  private readonly grabbed = (): void => {
    this.leavePreset();
  };

  /// Following continues while the user turns and zooms.
  private leavePreset(): CameraPlace {
    const place = this.place();
    this.flight = null;
    this.preset = this.following ? "follow" : null;
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

function reducedMotion(): boolean {
  return globalThis.matchMedia?.("(prefers-reduced-motion: reduce)").matches ?? false;
}
