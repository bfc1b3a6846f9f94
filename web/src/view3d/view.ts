// SPDX-License-Identifier: Apache-2.0
// The 3D view: a frame is drawn when something has changed, at most as often as the screen shows one.
import type { WebGLRenderer } from "three";
import type { Tick } from "../gen/phalanx/tick_pb";
import type { ThemeName } from "../theme";
import { CameraRig } from "./camera_rig";
import { Canvas, isSoftware, marked } from "./canvas";
import type { ViewTrouble } from "./canvas";
import { HandScene } from "./hand_scene";
import type { CameraPreset, HandView, ShownParts, ViewProbe } from "./hand_view";
import { highestQuality, pixelRatioFor, QualityWatch, qualityLevels } from "./quality";
import type { Shapes } from "./shapes";
import type { SkinToneName } from "./skin_tones";

export type { ViewTrouble } from "./canvas";

export interface HandViewOptions {
  readonly quality?: number; // 0 .. 3: stays there; otherwise it finds its own
  readonly onTrouble?: (what: ViewTrouble) => void; // the page has to report it
}

/// @param host  an element with a size of its own; the view fills it
export function createHandView(host: HTMLElement, options: HandViewOptions = {}): HandView {
  return new View(host, options);
}

const kSoftwareQuality = 1; // where the processor draws
const kContinuous = 0.025; // [s] a demand within this time of a frame: the next one comes as soon as it can
const kRateWindow = 1; // [s]
const kNoTick = 0n; // before the first tick

class View implements HandView {
  private readonly surface = document.createElement("div");
  private readonly canvas: Canvas;
  private readonly content = new HandScene();
  private readonly rig: CameraRig;
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
  private size = { width: 0, height: 0 };

  constructor(host: HTMLElement, private readonly options: HandViewOptions) {
    this.surface.style.cssText = "position:relative;width:100%;height:100%;overflow:hidden;touch-action:none";
    host.append(this.surface);
    this.canvas = new Canvas(this.surface, this.restored, () => this.content.release(), (what) => options.onTrouble?.(what));
    this.rig = new CameraRig(this.surface, this.demand);
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

  setSkinTone(tone: SkinToneName): void {
    this.content.setSkinTone(tone);
    this.redraw();
  }

  camera(preset: CameraPreset): void {
    this.rig.goTo(preset, this.content.sight(), now());
  }

  zoom(factor: number): void {
    this.rig.zoom(factor);
  }

  orbit(right: number, up: number): void {
    this.rig.orbit(right, up);
  }

  probe(): ViewProbe {
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
    };
  }

  picture(mark = ""): string {
    if (!this.renderer) return "";
    this.draw(now()); // the canvas keeps nothing between frames
    return marked(this.renderer.domElement, mark).toDataURL("image/png");
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
    this.takeTick();
    const moving = this.rig.update(at, at - this.lastFrame, this.content.grip());
    this.content.lights.follow(this.rig.camera, this.rig.target);
    const renderer = this.renderer!;
    renderer.clear();
    renderer.render(this.content.scene, this.rig.camera);
    renderer.clearDepth();
    renderer.render(this.content.over, this.rig.camera);
    ++this.frames;
    this.lastFrame = at;
    this.recent = [...this.recent.filter((time) => time > at - kRateWindow), at];
    if (moving) this.demand();
  }

  private takeTick(): void {
    if (!this.pending) return;
    if (this.content.show(this.pending)) this.shownTick = this.pending.tick;
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
    this.rig.setAspect(width / height);
    if (this.seen && this.rig.preset && this.rig.preset !== "follow") this.rig.goTo(this.rig.preset, this.content.sight(), null);
  }

  private readonly visibility = (): void => {
    this.watch.interrupted();
    this.redraw();
  };
}

function now(): number {
  return performance.now() / 1000;
}
