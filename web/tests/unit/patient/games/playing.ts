// SPDX-License-Identifier: Apache-2.0
// Exercises for tests of games, and a page without a graphics card that notes what a game does.
import { Vector3, type Camera, type Mesh, type Object3D, type Scene } from "three";
import type { ExerciseNow, Game, GameOptions, GameParts, MakeGame, Target } from "../../../../src/patient/game";

export type Now = Partial<Omit<ExerciseNow, "target">> & { readonly target?: Partial<Target> };

export function exercise(now: Now = {}): ExerciseNow {
  const target: Target = { kind: "none", digits: [], force: [], low: 0, high: 0, depth: 0, sponge: -1, flexion: [], ...now.target };
  return {
    number: 1, name: "one", title: "One", measure: "press_and_hold", training: false, symbol: "boat", side: "right", simulated: false, stage: "running", phase: "trial",
    instruction: "", note: "", trial: 1, trials: 8, progress: 0.5, remaining: 3, value: undefined, valueUnit: "", choices: [], asks: undefined, hidesScene: false, successes: 0,
    counted: 0, lastSuccess: false, force: [0, 0, 0, 0, 0], touching: [false, false, false, false, false], flexion: [0.2, 0.2, 0.2, 0.2, 0.2], padDistance: [0.09, 0.09, 0.09, 0.09],
    forcesOff: false, trouble: "", ...now, target,
  };
}

export interface Played {
  readonly game: Game;
  readonly notes: number[]; // pitches
  readonly drawn: () => number; // frames
  readonly scene: () => Scene;
  readonly camera: () => Camera;
  /// Plays this long, as 30 frames a second.
  readonly play: (now: Now, seconds?: number) => void;
}

export function played(make: MakeGame, first: Now, options: Partial<GameOptions> = {}, able = true): Played {
  const notes: number[] = [];
  let frames = 0;
  let last: { scene: Scene; camera: Camera } | undefined;
  const parts: GameParts = {
    options: { aphasia: false, numbers: false, cues: "centre", calm: false, contrast: false, ...options },
    sound: { note: (pitch) => notes.push(pitch), glad: () => notes.push(-1) },
    stage: { able, draw: (scene, camera) => { ++frames; last = { scene, camera }; } },
  };
  const game = make(parts);
  game.begin(exercise(first));
  game.size(1280, 800, { left: 0, top: 120, width: 1280, height: 540 });
  return {
    game, notes, drawn: () => frames, scene: () => last!.scene, camera: () => last!.camera,
    play: (now, seconds = 2) => {
      const state = exercise(now);
      for (let frame = 0; frame < seconds * 30; ++frame) game.show(state, 1 / 30);
    },
  };
}

/// All that is drawn, as text: places, turns, sizes, colours and what an object's points are.
export function pictured(scene: Object3D, element?: HTMLElement): string {
  const parts: string[] = [element?.innerHTML ?? ""];
  const number = (value: number) => value.toFixed(5);
  scene.updateMatrixWorld(true);
  scene.traverse((object) => {
    const { material } = object as Mesh;
    const one = Array.isArray(material) ? material[0] : material;
    parts.push(`${object.type} ${object.visible} ${object.matrixWorld.elements.map(number).join(" ")} ${one ? number(one.opacity) : ""}`);
  });
  return parts.join("\n");
}

/// Extent of what is visible within a region around the middle, for tests of what grows.
export function heightOf(object: Object3D): number {
  return object.getWorldPosition(new Vector3()).y;
}
