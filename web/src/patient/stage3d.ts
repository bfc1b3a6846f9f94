// SPDX-License-Identifier: Apache-2.0
// The page's one WebGL canvas. It lies behind everything; a game draws on it, or else the page's own calm sky over a lake is there.
import { PerspectiveCamera, Scene, WebGLRenderer, type Camera } from "three";
import { QualityWatch, pixelRatioFor, qualityLevels } from "../view3d/quality";
import type { GameOptions, GameStage } from "./game";
import { World } from "./world";

const kFirstLevel = 2;
const kShift = 0.17; // of the picture, towards the side of the cues, as a share of the width
const kFieldOfView = 46; // [deg]
const kCalmSpeed = 0.12; // of waves and clouds at reduced motion

export class Stage3d implements GameStage {
  private readonly renderer: WebGLRenderer | undefined;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(kFieldOfView, 1, 0.1, 600);
  private readonly world: World | undefined;
  private readonly watch = new QualityWatch(kFirstLevel);
  private width = 1;
  private height = 1;
  private drawn = false;
  private time = 0;
  private lost = false; // the graphics card took the canvas away

  constructor(canvas: HTMLCanvasElement, private readonly options: () => GameOptions) {
    try {
      this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "low-power" });
    } catch {
      return; // words and pictures of the page do without
    }
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.lost = true;
    });
    canvas.addEventListener("webglcontextrestored", () => (this.lost = false));
    this.world = new World();
    this.scene.add(this.world.sky, this.world.water);
    this.camera.position.set(0, 2.2, 0);
  }

  get able(): boolean {
    return this.renderer !== undefined && !this.lost;
  }

  size(width: number, height: number): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.watch.interrupted();
    this.resize();
  }

  private resize(): void {
    const level = qualityLevels[this.watch.level]!;
    this.renderer?.setPixelRatio(pixelRatioFor(level, this.width, this.height, window.devicePixelRatio));
    this.renderer?.setSize(this.width, this.height, false);
  }

  /// Draws a frame. @param dt  since the last one [s]  @param show  lets the game draw
  frame(dt: number, show: () => void): void {
    if (this.able && this.watch.frame(dt)) this.resize(); // before it is drawn: a new size empties the canvas
    this.drawn = false;
    show();
    if (!this.drawn) this.drawSky(dt);
  }

  draw(scene: Scene, camera: Camera): void {
    if (!this.renderer || this.lost) return;
    this.drawn = true;
    if (camera instanceof PerspectiveCamera) {
      camera.aspect = this.width / this.height;
      const { cues } = this.options();
      const shift = cues === "centre" || this.width < this.height ? 0 : (cues === "left" ? 1 : -1) * kShift * this.width;
      const view = camera.view;
      const [x, y] = [shift, view?.enabled ? view.offsetY : 0];
      if (shift !== 0 || view?.enabled) camera.setViewOffset(this.width, this.height, x, y, this.width, this.height);
      camera.updateProjectionMatrix();
    }
    this.renderer.render(scene, camera);
  }

  private drawSky(dt: number): void {
    if (!this.world) return;
    const { calm, contrast } = this.options();
    this.time += dt * (calm ? kCalmSpeed : 0.8);
    this.world.setDay(0.04, contrast);
    this.world.move(this.time, 0, 0.8);
    this.camera.rotation.set(0.055 + (calm ? 0 : 0.006 * Math.sin(0.11 * this.time)), calm ? 0 : 0.02 * Math.sin(0.07 * this.time), 0);
    this.draw(this.scene, this.camera);
  }
}
