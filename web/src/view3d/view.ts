// SPDX-License-Identifier: Apache-2.0
// The 3D view: a frame is drawn when something has changed, at most as often as the screen shows one.
import type { WebGLRenderer } from "three";
import type { Tick } from "../gen/phalanx/tick_pb";
import type { ThemeName } from "../theme";
import type { FreePart } from "./camera_presets";
import { CameraRig, FixedCamera } from "./camera_rig";
import { Canvas, isSoftware } from "./canvas";
import type { ViewTrouble } from "./canvas";
import { ForceLabels, placedLabels, type PlacedLabel } from "./force_labels";
import type { ForceScale } from "./force_scale";
import { HandScene } from "./hand_scene";
import type { CameraPreset, HandView, Pane, ShownParts, ViewProbe } from "./hand_view";
import { kMostViews, panesFor, viewsWithRoom } from "./panes";
import { highestQuality, pixelRatioFor, QualityWatch, qualityLevels } from "./quality";
import { savedPicture } from "./saved_picture";
import type { Shapes } from "./shapes";
import type { SkinToneName } from "./skin_tones";

export type { ViewTrouble } from "./canvas";

export interface HandViewOptions {
  readonly quality?: number; // 0 .. 3: stays there; otherwise it finds its own
  readonly onPanes?: (panes: readonly Pane[]) => void; // other views than before
  readonly onTrouble?: (what: ViewTrouble) => void; // the page has to report it
}

/// @param host  an element with a size of its own; the view fills it
export function createHandView(host: HTMLElement, options: HandViewOptions = {}): HandView {
  return new View(host, options);
}

const kSoftwareQuality = 1; // where the processor draws
const kContinuous = 0.025; // [s] a demand within this time of a frame: the next one comes as soon as it can
const kRateWindow = 1; // [s]
const kGap = 2; // between views [pixels of the style sheet]
const kNoTick = 0n; // before the first tick

class View implements HandView {
  private readonly surface = document.createElement("div");
  private readonly drawn = document.createElement("div"); // holds the canvas
  private readonly grip = document.createElement("div"); // over the first view: takes mouse and touch
  private readonly canvas: Canvas;
  private readonly figures = new ForceLabels();
  private readonly content = new HandScene();
  private readonly rig: CameraRig;
  private readonly others = Array.from({ length: kMostViews - 1 }, () => new FixedCamera());
  private readonly watch: QualityWatch;
  private readonly resizing: ResizeObserver;
  private renderer: WebGLRenderer | null = null;
  private request = 0; // of the next frame, 0: none
  private demanded = 0; // time of the request [s]
  private lastFrame = 0;
  private frames = 0;
  private recent: number[] = []; // when the frames of the last second were
  private pending: Tick | null = null;
  private shownTick = kNoTick;
  private seen = false; // a hand has been in the picture since the last geometry
  private kind = ""; // of the object
  private meaning = ""; // of forces
  private size = { width: 0, height: 0 };
  private told: string | null = null; // which views the page knows
  private views = 1; // that are wished
  private covered = 0; // of the upper edge [pixels of the style sheet]

  constructor(host: HTMLElement, private readonly options: HandViewOptions) {
    this.surface.style.cssText = "position:relative;width:100%;height:100%;overflow:hidden";
    this.drawn.style.cssText = "position:absolute;inset:0";
    this.grip.style.cssText = "position:absolute;inset:0 auto 0 0;width:100%;touch-action:none";
    this.surface.append(this.drawn, this.figures.element, this.grip);
    host.append(this.surface);
    this.canvas = new Canvas(this.drawn, this.restored, () => this.content.release(), (what) => options.onTrouble?.(what));
    this.rig = new CameraRig(this.grip, this.demand);
    this.watch = new QualityWatch(options.quality ?? highestQuality);
    this.renderer = this.canvas.use(qualityLevels[this.watch.level]!.antialias);
    if (this.renderer && options.quality === undefined && isSoftware(this.renderer)) this.watch.level = kSoftwareQuality;
    this.resizing = new ResizeObserver(this.resize);
    this.resizing.observe(this.surface);
    document.addEventListener("visibilitychange", this.visibility);
    this.applyQuality();
    this.resize();
  }

  setGeometry(shapes: Shapes): void {
    this.content.setGeometry(shapes);
    this.pending = null;
    this.shownTick = kNoTick; // what is shown of it comes with the next tick
    this.seen = false;
    this.watch.interrupted();
    this.redraw();
  }

  show(tick: Tick): void {
    this.pending = tick;
    this.demand();
  }

  setLost(lost: boolean): void {
    this.content.setLost(lost);
    this.redraw();
  }

  setParts(parts: ShownParts): void {
    this.content.setParts(parts);
    this.redraw();
  }

  setTheme(theme: ThemeName): void {
    this.content.setTheme(theme);
    this.redraw();
  }

  setObjectKind(kind: string): void {
    if (kind === this.kind) return; // State comes twice a second
    this.kind = kind;
    this.content.setObjectKind(kind);
    this.redraw();
  }

  setForces(scale: ForceScale, felt: readonly boolean[]): void {
    const meaning = `${scale.end} ${scale.limit} ${felt.join(" ")}`;
    if (meaning === this.meaning) return; // State comes twice a second
    this.meaning = meaning;
    this.content.setForces(scale, felt);
    this.redraw();
  }

  setSkinTone(tone: SkinToneName): void {
    this.content.setSkinTone(tone);
    this.redraw();
  }

  camera(preset: CameraPreset): void {
    this.rig.goTo(preset, this.content.sight(), now());
  }

  setViews(count: number): void {
    this.views = count;
    this.fit();
    this.redraw();
  }

  setCovered(top: number): void {
    if (top === this.covered) return;
    this.covered = top;
    this.fit();
    this.redraw();
  }

  zoom(factor: number): void {
    this.rig.zoom(factor);
  }

  orbit(right: number, up: number): void {
    this.rig.orbit(right, up);
  }

  probe(): ViewProbe {
    const { geometries, textures } = this.renderer?.info.memory ?? { geometries: 0, textures: 0 };
    return {
      frames: this.frames,
      tick: this.shownTick,
      shown: this.content.hands.shownOrigins(),
      ghost: this.content.hands.ghostOrigins(),
      skin: this.content.hands.shownSkin(),
      arrows: this.content.marks.drawn(),
      ...this.content.marks.counts(),
      quality: this.watch.level,
      framesPerSecond: this.recent.filter((at) => at > now() - kRateWindow).length / kRateWindow,
      lost: this.content.dead,
      panes: this.panes,
      handInPicture: this.rig.sees(this.content.hands.corners()),
      geometries,
      textures,
    };
  }

  picture(mark = ""): string {
    if (!this.renderer) return "";
    this.draw(now()); // the canvas keeps nothing between frames
    return savedPicture(this.renderer.domElement, mark, this.labels(), this.size.height).toDataURL("image/png");
  }

  dispose(): void {
    cancelAnimationFrame(this.request);
    this.request = -1; // nothing asks for a frame any more
    document.removeEventListener("visibilitychange", this.visibility);
    this.resizing.disconnect();
    this.rig.dispose();
    this.content.dispose();
    this.canvas.dispose();
    this.renderer = null;
    this.surface.remove();
  }

  private readonly demand = (): void => {
    if (this.request !== 0 || !this.renderer) return;
    this.demanded = now();
    this.request = requestAnimationFrame(this.frame);
  };

  private readonly redraw = (): void => {
    if (this.renderer) this.renderer.shadowMap.needsUpdate = true;
    this.demand();
  };

  /// What the graphics card had made is gone.
  private readonly restored = (): void => {
    this.content.release();
    this.applyQuality();
  };

  private readonly frame = (): void => {
    this.request = 0;
    const at = now();
    const step = at - this.lastFrame;
    if (this.demanded - this.lastFrame < kContinuous && this.options.quality === undefined && this.watch.frame(step)) this.applyQuality();
    if (this.canvas.usable) this.draw(at);
  };

  private draw(at: number): void {
    const step = at - this.lastFrame;
    this.takeTick(at);
    this.content.follow(step);
    const sight = () => this.content.sight();
    this.rig.keepInPicture(this.content.hands.corners(), sight, at);
    let moving = this.rig.update(at, step, sight);
    const renderer = this.renderer!;
    renderer.setScissorTest(false);
    renderer.clear();
    const { panes } = this;
    this.tellPanes(panes);
    renderer.setScissorTest(panes.length > 1);
    panes.forEach((pane, i) => {
      const other = i === 0 ? null : this.others[i - 1]!;
      if (other && pane.preset) moving = other.update(pane.preset, sight(), this.aspectOf(pane), this.free, step) || moving;
      this.drawPane(renderer, pane, other ?? this.rig);
    });
    this.figures.show(qualityLevels[this.watch.level]!.figures ? this.labels() : []);
    ++this.frames;
    this.lastFrame = at;
    this.recent = [...this.recent.filter((time) => time > at - kRateWindow), at];
    if (moving) this.demand();
  }

  /// Figures of the first view.
  private labels(): PlacedLabel[] {
    return placedLabels(this.content.labels(), this.rig.camera, this.panes[0]!.width * this.size.width, this.size.height);
  }

  private drawPane(renderer: WebGLRenderer, pane: Pane, { camera, target }: Pick<CameraRig, "camera" | "target">): void {
    const { width, height } = this.size;
    const left = Math.round(pane.left * width);
    const right = Math.round((pane.left + pane.width) * width);
    renderer.setViewport(left, 0, right - left, height);
    renderer.setScissor(left + (pane.left > 0 ? kGap : 0), 0, right - left, height);
    this.content.lights.follow(camera, target);
    renderer.render(this.content.scene, camera);
    renderer.clearDepth();
    renderer.render(this.content.over, camera);
  }

  private tellPanes(panes: readonly Pane[]): void {
    const names = panes.map((pane) => pane.preset).join(" ");
    if (names === this.told) return;
    this.told = names;
    this.options.onPanes?.(panes);
  }

  private get panes(): Pane[] {
    return panesFor(viewsWithRoom(this.views, this.size.width), this.rig.preset);
  }

  private aspectOf(pane: Pane): number {
    return (pane.width * this.size.width) / Math.max(1, this.size.height);
  }

  /// Without what the page lays over the upper edge.
  private get free(): FreePart {
    return { left: -1, right: 1, bottom: -1, top: 1 - Math.min(1, (2 * this.covered) / Math.max(1, this.size.height)) };
  }

  private takeTick(at: number): void {
    if (!this.pending) return;
    if (this.content.show(this.pending, at)) this.shownTick = this.pending.tick;
    this.pending = null;
    this.renderer!.shadowMap.needsUpdate = true;
    if (this.seen || this.content.hands.palm() === null) return;
    this.seen = true;
    if (this.rig.preset) this.rig.goTo(this.rig.preset, this.content.sight(), null);
  }

  private applyQuality(): void {
    const settings = qualityLevels[this.watch.level]!;
    this.renderer = this.canvas.use(settings.antialias);
    this.content.setQuality(settings, this.renderer);
    this.fit();
    this.redraw();
  }

  private readonly resize = (): void => {
    const { clientWidth: width, clientHeight: height } = this.surface;
    if (width === this.size.width && height === this.size.height) return;
    this.size = { width, height };
    this.watch.interrupted();
    this.fit();
    this.redraw();
  };

  private fit(): void {
    const { width, height } = this.size;
    if (!this.renderer || width === 0 || height === 0) return;
    this.renderer.setPixelRatio(pixelRatioFor(qualityLevels[this.watch.level]!, width, height, devicePixelRatio));
    this.renderer.setSize(width, height, false);
    const [main] = this.panes as [Pane];
    this.grip.style.width = `${100 * main.width}%`;
    this.rig.setPicture(this.aspectOf(main), this.free);
    if (this.seen && this.rig.preset) this.rig.goTo(this.rig.preset, this.content.sight(), null);
  }

  private readonly visibility = (): void => {
    this.watch.interrupted();
    this.redraw();
  };
}

function now(): number {
  return performance.now() / 1000;
}
