// SPDX-License-Identifier: Apache-2.0
// How much the renderer may spend, and who decides it: the time between frames while there is something new to draw.

/// outline: over the shown hand only an outline, elsewhere filled; peeled: its depth first, so that one layer of it is seen; plain: in one go.
export type GhostDetail = "outline" | "peeled" | "plain";

export interface QualitySettings {
  readonly pixelRatio: number; // at most this, and at most the screen's own
  readonly pixels: number; // at most so many on the whole canvas
  readonly shadow: number; // edge of the shadow map, 0: none but the painted one
  readonly antialias: boolean;
  readonly ghost: GhostDetail;
  readonly rich: boolean; // surroundings light the scene, materials have layers, fingers darken the object, the skin has creases
  readonly smooth: boolean; // the object has its display mesh
  readonly grain: boolean; // of the table
  readonly figures: boolean; // at the arrows' tips
}

/// Lowest first.
export const qualityLevels: readonly QualitySettings[] = [
  { pixelRatio: 1, pixels: 160_000, shadow: 0, antialias: false, ghost: "plain", rich: false, smooth: false, grain: false, figures: false },
  { pixelRatio: 1, pixels: 500_000, shadow: 0, antialias: false, ghost: "peeled", rich: false, smooth: true, grain: true, figures: true },
  { pixelRatio: 1.5, pixels: 2_000_000, shadow: 768, antialias: true, ghost: "outline", rich: true, smooth: true, grain: true, figures: true },
  { pixelRatio: 2, pixels: 8_000_000, shadow: 1024, antialias: true, ghost: "outline", rich: true, smooth: true, grain: true, figures: true },
];
export const highestQuality = qualityLevels.length - 1;

/// Pixels of the canvas per pixel of the style sheet.
export function pixelRatioFor(settings: QualitySettings, width: number, height: number, screenRatio: number): number {
  const byArea = Math.sqrt(settings.pixels / Math.max(1, width * height));
  return Math.min(settings.pixelRatio, screenRatio, byArea);
}

const kWindow = 16; // frames that are judged together
const kSettle = 4; // frames after a change that do not count: new shaders are compiled then
const kSlow = 1 / 24; // [s] mean above: down
const kVerySlow = 1 / 9; // [s] mean above: down by two, and judged after fewer frames
const kFewFrames = 4;
const kFast = 1 / 45; // [s] mean below, for long enough: up
const kFirstPatience = 8; // [s] of fast frames before a step up; doubles with each step up that did not last
const kLasts = 60; // [s] a step up that is taken back sooner did not last
const kMostTries = 3; // steps up that did not last; then there are no more
const kLongestFrame = 1; // [s] longer: the page was hidden or the machine asleep

/// Feed it the time between frames that followed each other as fast as they could; it says which level to use. It goes down
/// soon, and up late: after a step up that did not last it waits twice as long before the next, and after the third it stays down.
export class QualityWatch {
  level: number;
  private frames = 0;
  private sum = 0;
  private settle = kSettle;
  private fastFor = 0;
  private patience = kFirstPatience;
  private sinceUp = Infinity; // [s] of frames
  private tries = 0; // steps up that did not last

  constructor(level: number = highestQuality) {
    this.level = Math.min(highestQuality, Math.max(0, Math.round(level)));
  }

  /// @param seconds  since the frame before  @returns true if the level has changed
  frame(seconds: number): boolean {
    if (!(seconds > 0) || seconds > kLongestFrame) return this.interrupted();
    if (this.settle > 0) {
      --this.settle;
      return false;
    }
    ++this.frames;
    this.sum += seconds;
    const mean = this.sum / this.frames;
    if (this.frames >= kFewFrames && mean > kVerySlow) return this.down(2);
    if (this.frames < kWindow) return false;
    const lasted = this.sum;
    this.frames = this.sum = 0;
    this.sinceUp += lasted;
    if (mean > kSlow) return this.down(1);
    this.fastFor = mean < kFast ? this.fastFor + lasted : 0;
    return this.level < highestQuality && this.fastFor > this.patience && this.tries < kMostTries && this.up();
  }

  /// The next frame's time does not count: the page was hidden, the canvas resized, or a new shape came.
  interrupted(): false {
    this.frames = this.sum = 0;
    this.settle = kSettle;
    return false;
  }

  private down(steps: number): boolean {
    if (this.sinceUp < kLasts) {
      this.patience *= 2;
      ++this.tries;
    }
    this.sinceUp = Infinity;
    return this.change(Math.max(0, this.level - steps));
  }

  private up(): boolean {
    this.sinceUp = 0;
    return this.change(this.level + 1);
  }

  private change(level: number): boolean {
    this.interrupted();
    this.fastFor = 0;
    const changed = level !== this.level;
    this.level = level;
    return changed;
  }
}
