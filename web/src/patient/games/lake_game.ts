// SPDX-License-Identifier: Apache-2.0
// A goal on a lake between hills: what the calm goals share. Each one has a region in which all that matters takes place; the camera keeps
// this region in the part of the page that words and buttons leave free.
import { DirectionalLight, HemisphereLight, PerspectiveCamera, Scene } from "three";
import type { ExerciseNow, Free, Game, GameParts } from "../game";
import { World } from "../world";
import { dispose, eased } from "./marks";
import { PlainGoal } from "./plain_goal";

/// Upright rectangle at z = 0 in which the goal takes place, over the water at y = 0 [m].
export interface Region {
  readonly width: number;
  readonly height: number;
  readonly middle: number; // height of its middle
}

const kFieldOfView = 36; // [deg], upright
const kEyeHeight = 1.7; // [m]
/// Shift of the picture towards the side of the cues, as a share of the width, as the page's stage does it.
export const kShift = 0.17;
const kHandShare = 0.15; // of the width: the page's drawn hand in aphasia mode, lower left
const kPan = 4; // pace of the camera [1/s]
const kCalmSpeed = 0.12; // of waves and clouds with reduced motion, as on the page's own sky

interface View {
  readonly distance: number; // of the camera [m]
  readonly at: number; // height of what it looks at [m]
}

/// Distance of the camera and height of what it looks at, so that the region lies in the free part of a page. @param height  of the page
export function fitted(region: Region, height: number, free: Free): View {
  const perPixel = Math.max(region.width / Math.max(1, free.width), region.height / Math.max(1, free.height));
  const distance = (0.5 * perPixel * Math.max(1, height)) / Math.tan((kFieldOfView / 360) * Math.PI);
  const below = free.top + free.height / 2 - height / 2; // [pixels]
  return { distance, at: region.middle + below * perPixel };
}

export abstract class LakeGame implements Game {
  readonly element = document.createElement("div");
  protected readonly scene = new Scene();
  protected readonly camera = new PerspectiveCamera(kFieldOfView, 1, 0.1, 1200);
  protected time = 0; // of what sways by itself [s]
  private readonly world = new World();
  private readonly plain = new PlainGoal();
  private sized: { readonly width: number; readonly height: number; readonly free: Free; readonly cues: string; readonly aphasia: boolean } | undefined;
  private wanted: View | undefined;
  private placed: View | undefined;

  /// @param day  time of day, 0 early morning .. 1 evening
  constructor(protected readonly parts: GameParts, private readonly day: number, protected region: Region) {
    this.element.className = "lake-game";
    this.scene.add(this.world.sky, this.world.water);
    const heaven = new HemisphereLight("#ffffff", "#7d9aa8", 2.1);
    const lamp = new DirectionalLight("#fff4e2", 2.4);
    lamp.position.set(-5, 9, 10);
    const rim = new DirectionalLight("#ffdcae", 1.6);
    rim.position.set(6, 4, -9);
    this.scene.add(heaven, lamp, rim);
  }

  begin(exercise: ExerciseNow): void {
    this.build(exercise);
  }

  show(exercise: ExerciseNow, dt: number): void {
    const { options, stage } = this.parts;
    if (!stage.able) {
      if (this.plain.element.parentElement !== this.element) this.element.prepend(this.plain.element);
      this.plain.show(exercise, options);
      this.update(exercise, dt); // its sounds
      return;
    }
    if (this.plain.element.parentElement) this.plain.element.remove();
    const { sized } = this;
    if (sized && (sized.cues !== options.cues || sized.aphasia !== options.aphasia)) this.size(sized.width, sized.height, sized.free);
    this.time += dt * (options.calm ? kCalmSpeed : 1);
    this.world.setDay(this.day, options.contrast);
    this.world.move(this.time * 0.8, 0, 0.8);
    if (this.wanted && this.placed && this.wanted !== this.placed) {
      const { distance, at } = this.wanted;
      const near = Math.abs(distance - this.placed.distance) < 0.01 && Math.abs(at - this.placed.at) < 0.01;
      this.place(near ? this.wanted : { distance: eased(this.placed.distance, distance, dt, kPan), at: eased(this.placed.at, at, dt, kPan) });
    }
    this.update(exercise, dt);
    stage.draw(this.scene, this.camera);
  }

  size(width: number, height: number, free: Free): void {
    const { cues, aphasia } = this.parts.options;
    this.sized = { width, height, free, cues, aphasia };
    // The page shifts the picture towards the side of the cues; what is beside it must not be cut off.
    const shifted = cues !== "centre" && width >= height;
    // The picture's middle is that of the page, so that what is covered at the left counts twice.
    const most = shifted ? (1 - 2 * kShift - (aphasia && cues === "left" ? 2 * kHandShare : 0)) * width : width - 2 * free.left;
    this.wanted = fitted(this.region, height, { ...free, width: Math.min(free.width, most) });
    if (!this.placed) this.place(this.wanted);
  }

  /// Moves the camera. When words come or go, it takes about a second.
  private place(view: View): void {
    this.placed = view;
    this.camera.position.set(0, kEyeHeight, view.distance);
    this.camera.lookAt(0, view.at, 0);
  }

  end(): void {
    dispose(this.scene);
    this.world.dispose();
  }

  /// Makes what the scene consists of.
  protected abstract build(exercise: ExerciseNow): void;
  /// Moves it as the exercise is now.
  protected abstract update(exercise: ExerciseNow, dt: number): void;
}
