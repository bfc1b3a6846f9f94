// SPDX-License-Identifier: Apache-2.0
// Counting flashes of what a game draws, without a graphics card.
import type { Object3D, Sprite } from "three";

/// Pairs of changes, there and back, of a tenth of `full` or more.
export function flashes(values: readonly number[], full = Math.max(...values)): number {
  const step = 0.1 * full;
  let [extreme, rising, turns] = [values[0]!, true, 0];
  for (const value of values) {
    if (rising ? value > extreme : value < extreme) extreme = value;
    else if (Math.abs(value - extreme) >= step) {
      ++turns;
      rising = !rising;
      extreme = value;
    }
  }
  return Math.ceil(turns / 2);
}

/// The most flashes that any second of frames has.
export function mostInASecond(values: readonly number[], rate: number, full = Math.max(...values)): number {
  let most = 0;
  for (let from = 0; from + rate <= values.length; from += Math.ceil(rate / 4)) most = Math.max(most, flashes(values.slice(from, from + rate), full));
  return most;
}

/// The soft lights of a scene that are seen.
export function lightsOf(scene: Object3D): readonly Sprite[] {
  const found: Sprite[] = [];
  scene.traverse((object) => object.type === "Sprite" && found.push(object as Sprite));
  return found;
}

/// What a soft light adds to the picture: its opacity times its area; 0 where it, or what it belongs to, is hidden.
export function lightOf(sprite: Sprite): number {
  let light = sprite.material.opacity;
  for (let at: Object3D | null = sprite; at; at = at.parent) {
    if (!at.visible) return 0;
    light *= Math.abs(at.scale.x * at.scale.y);
  }
  return light;
}

/// Gives canvases a pen that paints nothing, so that games make their soft lights. To be given to beforeAll, which calls the answer after the
/// last test: the files of tests share a process.
export function fakePens(): () => void {
  const { getContext } = HTMLCanvasElement.prototype;
  const gradient = { addColorStop: () => undefined };
  const pen = new Proxy({}, { get: (_, name) => (String(name).endsWith("Gradient") ? () => gradient : () => undefined), set: () => true });
  HTMLCanvasElement.prototype.getContext = function (kind: string) {
    return kind === "2d" ? pen : null;
  } as unknown as typeof getContext;
  return () => {
    HTMLCanvasElement.prototype.getContext = getContext;
  };
}
