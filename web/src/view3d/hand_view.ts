// SPDX-License-Identifier: Apache-2.0
// The 3D view. The contract between it and the rest of the page; everything else in this folder is its own.
import type { Tick } from "../gen/phalanx/tick_pb";
import type { ThemeName } from "../theme";
import type { ForceScale } from "./force_scale";
import type { DrawnVertex, Point } from "./posed_hand";
import type { Shapes } from "./shapes";
import type { SkinToneName } from "./skin_tones";

export type CameraPreset = "home" | "palm" | "thumb" | "contact";

export interface ShownParts {
  readonly skin: boolean; // false: the rigid segments that the search sees
  readonly ghost: boolean; // the measured hand
  readonly arrows: boolean;
  readonly object: boolean;
  readonly cones: boolean; // of friction, at each contact point of sliding mode
}

/// One of several views side by side, from left to right; the first is the one that mouse and keys move.
export interface Pane {
  readonly preset: CameraPreset | null; // null: moved by hand
  readonly left: number; // share of the width
  readonly width: number;
}

/// The content of the last frame, for tests and inspection. World frame, metres.
export interface ViewProbe {
  readonly frames: number;
  readonly tick: bigint; // shown
  readonly shown: readonly Point[]; // origin of each segment's frame as drawn, 16
  readonly ghost: readonly Point[];
  readonly skin: readonly DrawnVertex[]; // some of it; empty: the segments are shown
  readonly arrows: readonly { readonly segment: number; readonly length: number; readonly slips: boolean; readonly felt: boolean }[]; // visible ones [m]
  readonly rings: number; // visible, two where a finger slips
  readonly cones: number; // visible
  readonly quality: number; // 0 lowest .. 3
  readonly framesPerSecond: number;
  readonly lost: boolean; // grey
  readonly panes: readonly Pane[];
  readonly handInPicture: boolean; // all of it, in the first view
  readonly geometries: number; // that the graphics card holds
  readonly textures: number; // likewise
}

export interface HandView {
  setGeometry(shapes: Shapes): void;
  show(tick: Tick): void; // the newest; drawn at the next frame of the screen
  setLost(lost: boolean): void; // no measurement: the hand greys at once, ghost and arrows go
  setParts(parts: ShownParts): void;
  setTheme(theme: ThemeName): void;
  setObjectKind(kind: string): void; // as scenes name it; empty: not known
  setSkinTone(tone: SkinToneName): void;
  setForces(scale: ForceScale, felt: readonly boolean[]): void; // felt: of each digit; a force that is not is drawn hollow
  camera(preset: CameraPreset): void;
  setViews(count: number): void; // side by side, 1 .. 3; fewer where there is no room
  setCovered(top: number): void; // so much of its upper edge is covered by the page [pixels of the style sheet]
  zoom(factor: number): void; // > 1: nearer
  orbit(right: number, up: number): void; // [rad], for keys
  probe(): ViewProbe;
  picture(mark?: string): string; // data URL of a PNG of what is seen now, with these words in it
  dispose(): void;
}
