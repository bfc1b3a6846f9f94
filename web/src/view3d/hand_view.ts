// SPDX-License-Identifier: Apache-2.0
// The 3D view. The contract between it and the rest of the page; everything else in this folder is its own.
import type { Tick } from "../gen/phalanx/tick_pb";
import type { ThemeName } from "../theme";
import type { DrawnVertex, Point } from "./posed_hand";
import type { Shapes } from "./shapes";
import type { SkinToneName } from "./skin_tones";

export type CameraPreset = "home" | "palm" | "thumb" | "follow";

export interface ShownParts {
  readonly skin: boolean; // false: the rigid segments that the search sees
  readonly ghost: boolean; // the measured hand
  readonly arrows: boolean;
  readonly object: boolean;
  readonly cones: boolean; // of friction, at each contact point of sliding mode
}

/// The content of the last frame, for tests and inspection. World frame, metres.
export interface ViewProbe {
  readonly frames: number;
  readonly tick: bigint; // shown
  readonly shown: readonly Point[]; // origin of each segment's frame as drawn, 16
  readonly ghost: readonly Point[];
  readonly skin: readonly DrawnVertex[]; // some of it; empty: the segments are shown
  readonly arrows: readonly { readonly segment: number; readonly length: number; readonly slips: boolean }[]; // visible ones [m]
  readonly rings: number; // visible, two where a finger slips
  readonly cones: number; // visible
  readonly quality: number; // 0 lowest .. 3
  readonly framesPerSecond: number;
  readonly lost: boolean; // grey
}

export interface HandView {
  setGeometry(shapes: Shapes): void;
  show(tick: Tick): void; // the newest; drawn at the next frame of the screen
  setLost(lost: boolean): void; // no measurement: the hand greys at once, ghost and arrows go
  setParts(parts: ShownParts): void;
  setTheme(theme: ThemeName): void;
  setObjectKind(kind: string): void; // as scenes name it; empty: not known
  setSkinTone(tone: SkinToneName): void;
  camera(preset: CameraPreset): void;
  zoom(factor: number): void; // > 1: nearer
  orbit(right: number, up: number): void; // [rad], for keys
  probe(): ViewProbe;
  picture(mark?: string): string; // data URL of a PNG of what is seen now, with these words in it
  dispose(): void;
}
