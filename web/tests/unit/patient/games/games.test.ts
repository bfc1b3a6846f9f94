// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from "vitest";
import { Vector3, type BufferGeometry, type Mesh, type Sprite } from "three";
import { gameFor } from "../../../../src/patient/games/registry";
import { makeFeel, shapeOf } from "../../../../src/patient/games/feel_and_find";
import { forceTop, nearness } from "../../../../src/patient/games/force_scale";
import { fitted } from "../../../../src/patient/games/lake_game";
import { Hoop, eased } from "../../../../src/patient/games/marks";
import { Crossing, makeMelody } from "../../../../src/patient/games/melody";
import { fountainHeight, makeBalloon, makeFountain, makePinch } from "../../../../src/patient/games/press";
import { makeFlower } from "../../../../src/patient/games/range";
import { arcAt, makeReach } from "../../../../src/patient/games/reach_line";
import { flashes } from "./flashes";
import { exercise, pictured, played, type Now } from "./playing";

const kMeasures = ["range_of_motion", "total_active_motion", "press_and_hold", "force_tracking", "squeeze_release", "pinch", "opposition", "independence", "smoothness", "feel_and_find", "object_in_hand", "own_force", "entry_check"];
const trials: readonly (readonly [name: string, make: typeof makeBalloon, now: Now])[] = [
  ["the balloon", makeBalloon, { measure: "press_and_hold", target: { kind: "force", digits: [1], low: 1.7, high: 2.3 }, value: 2 }],
  ["the fountain", makeFountain, { measure: "own_force", target: { kind: "squeeze", digits: [1] }, value: 4 }],
  ["the bubble", makePinch, { measure: "pinch", target: { kind: "force", digits: [0, 1], low: 2, high: 3 }, value: 2.5 }],
  ["the flower", makeFlower, { measure: "range_of_motion", target: { kind: "open", digits: [0, 1, 2, 3, 4] } }],
  ["the lantern", makeReach, { measure: "smoothness", target: { kind: "angle", digits: [1], flexion: [undefined, 0.7, undefined, undefined, undefined] } }],
  ["the melody", makeMelody, { measure: "independence", target: { kind: "close", digits: [2] } }],
  ["feel and find", makeFeel, { measure: "feel_and_find", hidesScene: true, target: { kind: "explore", digits: [1], sponge: 0 }, force: [], touching: [] }],
];

describe("games", () => {
  test("every measure has a game, for a training and for an assessment", () => {
    for (const measure of kMeasures) for (const training of [true, false]) expect(gameFor({ measure, training }), measure).toBeTypeOf("function");
    expect(gameFor({ measure: "unknown", training: false })).toBeUndefined();
  });

  test.each(trials)("%s draws every phase, also where numbers are missing", (_, make, now) => {
    const { play, drawn, scene, game } = played(make, now);
    for (const phase of ["warm_up", "rest", "trial", "answer", "paused", "done"] as const) play({ ...now, phase }, 0.2);
    play({ ...now, flexion: [NaN, NaN, NaN, NaN, NaN], force: [], touching: [], padDistance: [], value: undefined }, 0.2);
    play({ ...now, flexion: [], value: Infinity, target: { kind: "none" } }, 0.2);
    expect(drawn()).toBeGreaterThan(30);
    expect(pictured(scene(), game.element)).not.toMatch(/NaN|Infinity/);
    game.end();
  });

  test.each(trials)("%s shows a goal in plain shapes where the browser draws no 3D", (_, make, now) => {
    const { play, drawn, game } = played(make, now, {}, false);
    play(now, 0.2);
    expect(drawn()).toBe(0);
    expect(game.element.querySelector(".plain-goal")!.innerHTML.length).toBeGreaterThan(40);
    expect(game.element.innerHTML).not.toMatch(/NaN|Infinity/);
    game.end();
  });

  test.each(trials)("%s has no written word, for people who cannot read", (_, make, now) => {
    const { play, game } = played(make, now);
    play(now, 0.2);
    expect(game.element.textContent).toBe("");
    game.end();
  });

  test.each(trials)("%s stands still by itself with reduced motion, but for slow water", (_, make, now) => {
    const { play, scene, game } = played(make, now, { calm: true });
    play(now, 6);
    const before = pictured(scene());
    play(now, 1);
    const [a, b] = [before, pictured(scene())].map((text) => text.split(/[\s]+/).map(Number));
    const moved = Math.max(...a!.map((value, at) => Math.abs(value - b![at]!) || 0));
    expect(moved).toBeLessThan(0.02);
    game.end();
  });

  test("what matters lies in the part of the page that words leave free", () => {
    const region = { width: 6, height: 5, middle: 2 };
    const { distance, at } = fitted(region, 800, { left: 0, top: 100, width: 1000, height: 500 });
    expect(distance).toBeCloseTo((0.5 * 0.01 * 800) / Math.tan((18 * Math.PI) / 180), 9); // 0.01 m a pixel, by the height
    expect(at).toBeCloseTo(2 + 0.01 * (350 - 400), 9); // the free part's middle is 50 pixels above the page's
    expect(fitted(region, 800, { left: 0, top: 0, width: 300, height: 800 }).distance).toBeCloseTo((0.5 * 0.02 * 800) / Math.tan((18 * Math.PI) / 180), 9); // by the width
  });
});

describe("signs", () => {
  test("no sign changes faster than a third of a second, at any frame rate", () => {
    for (const rate of [20, 30, 60, 144]) {
      let share = 0;
      for (let frame = 0; frame < rate / 3; ++frame) share = eased(share, 1, 1 / rate);
      expect(share).toBeGreaterThan(0.6);
      expect(share).toBeLessThan(0.7);
    }
  });

  test("a hoop's beads are small outside and large inside of the goal: a shape, not only a colour", () => {
    const hoop = new Hoop(1, true);
    const bead = hoop.root.children[0]!.children[2]!;
    for (let frame = 0; frame < 90; ++frame) hoop.step(true, 0, 1 / 30);
    const small = bead.scale.x;
    for (let frame = 0; frame < 90; ++frame) hoop.step(true, 1, 1 / 30);
    expect(bead.scale.x / small).toBeGreaterThan(2.5);
    for (let frame = 0; frame < 90; ++frame) hoop.step(false, 1, 1 / 30);
    expect(hoop.root.visible).toBe(false);
  });

  test.each([1, 2, 3, 4, 5, 7, 10])("a force that shakes at %i Hz across its band makes the beads flash at most three times a second", (rate) => {
    const now = { measure: "press_and_hold", target: { kind: "force", digits: [1], low: 1.7, high: 2.3 } } as const;
    const { game, play, scene } = played(makeBalloon, now);
    play({ ...now, value: 2 }, 2);
    const hoop = scene().children.find((child) => child.children[0]?.children.length === 14)!;
    const sizes: number[] = [];
    for (let frame = 0; frame < 240; ++frame) {
      game.show(exercise({ ...now, value: (frame * rate) % 60 < 30 ? 0.2 : 2 }), 1 / 60);
      sizes.push(hoop.children[0]!.children[2]!.scale.x);
    }
    expect(flashes(sizes) / 4).toBeLessThanOrEqual(3);
    game.end();
  });

  test.each([1, 2, 3, 5, 8])("fingers that touch %i times a second make the bell's light flash at most three times a second", (rate) => {
    const now = { measure: "opposition", target: { kind: "touch", digits: [0, 2] } } as const;
    const { game, scene, notes } = played(makeMelody, now);
    const lights: number[] = [];
    for (let frame = 0; frame < 240; ++frame) {
      const distance = (frame * rate) % 60 < 30 ? 0.01 : 0.05;
      game.show(exercise({ ...now, padDistance: [0.09, distance, 0.09, 0.09] }), 1 / 60);
      lights.push(Math.max(...scene().children.map((child) => (child.type === "Sprite" ? (child as Sprite).material.opacity : 0)), 0, (scene().children.find((child) => child.children[0]?.children.length === 14)?.scale.x ?? 1) - 1));
    }
    expect(notes.length).toBeGreaterThanOrEqual(3);
    expect(Math.max(...lights)).toBeGreaterThan(0.05);
    expect(flashes(lights) / 4).toBeLessThanOrEqual(3);
    game.end();
  });
});

describe("forces", () => {
  test("the scale of a moving target is that of its largest value from the begin on, and never shrinks", () => {
    const at = (low: number, high: number) => exercise({ measure: "force_tracking", target: { kind: "force", digits: [1], low, high } });
    const first = forceTop(1, at(1.7, 2.3));
    expect(first).toBeCloseTo(1.35 * (1.5 * 2 + 0.3), 9);
    expect(forceTop(first, at(2.7, 3.3))).toBe(first); // its largest value
    expect(forceTop(first, at(0.7, 1.3))).toBe(first);
    expect(forceTop(3, exercise({ target: { kind: "none" } }))).toBe(3);
  });

  test("nearness is 1 within the band and falls beside it", () => {
    expect(nearness(2, 1.7, 2.3)).toBe(1);
    expect(nearness(1.7, 1.7, 2.3)).toBe(1);
    expect(nearness(1.275, 1.7, 2.3)).toBeCloseTo(0.5, 9);
    expect(nearness(0, 1.7, 2.3)).toBe(0);
  });

  test("the balloon rises with the force, and its middle is in the gate where the force is in the band", () => {
    const now = { measure: "press_and_hold", target: { kind: "force", digits: [1], low: 1.7, high: 2.3 } } as const;
    const { play, scene, game } = played(makeBalloon, now);
    const heights = [0, 1, 2, 3].map((value) => {
      play({ ...now, value }, 3);
      return scene().children[5]!.position.y;
    });
    for (let at = 1; at < 4; ++at) expect(heights[at]! - heights[at - 1]!).toBeGreaterThan(0.5);
    play({ ...now, value: 2 }, 3);
    const gate = scene().children.filter((child) => child.children[0]?.children.length === 14).map((child) => child.position.y).sort((a, b) => a - b);
    const middle = scene().children[5]!.position.y + 1.55;
    expect(middle).toBeGreaterThan(gate[0]!);
    expect(middle).toBeLessThan(gate[1]!);
    game.end();
  });

  test("a weak hand moves the fountain well, and a strong one finds no end of it", () => {
    expect(fountainHeight(1)).toBeGreaterThan(0.6);
    expect(fountainHeight(15)).toBeLessThan(4.6);
    expect(fountainHeight(15)).toBeGreaterThan(fountainHeight(10) + 0.3);
    expect(fountainHeight(-1)).toBe(0);
  });
});

describe("Melody", () => {
  const opposes = (distance: number, trial = 1, finger = 3): Now => ({ measure: "opposition", trial, target: { kind: "touch", digits: [0, finger] }, padDistance: [0.09, 0.09, 0.09, 0.09].map((far, at) => (at === finger - 1 ? distance : far)) });
  const bends = (flexion: readonly number[], kind: "open" | "close" = "close", trial = 1): Now => ({ measure: "independence", trial, target: { kind, digits: [2] }, flexion });

  test("one finger has one note: it sounds once for each touch, and only of the instructed finger", () => {
    const { play, notes } = played(makeMelody, opposes(0.09));
    play(opposes(0.09), 0.5);
    expect(notes).toEqual([]);
    play(opposes(0.01), 1);
    expect(notes).toEqual([3]);
    play(opposes(0.02), 0.3); // not away yet
    play(opposes(0.01), 0.3);
    expect(notes).toEqual([3]);
    play(opposes(0.05), 0.3);
    play(opposes(0.012), 0.3);
    expect(notes).toEqual([3, 3]);
    play({ ...opposes(0.09), padDistance: [0.005, 0.09, 0.09, 0.09] }, 0.5); // another finger
    expect(notes).toEqual([3, 3]);
  });

  test("a finger that is to move alone rings its bell when it bends; others make no sound", () => {
    const { play, notes } = played(makeMelody, bends([0, 0, 0, 0, 0], "open"));
    play(bends([0.9, 0.9, 0.1, 0.9, 0.9]), 0.5);
    expect(notes).toEqual([]);
    play(bends([0.1, 0.3, 0.8, 0.3, 0.1]), 0.5);
    expect(notes).toEqual([2]);
    play(bends([0, 0, 0, 0, 0], "open"), 0.5);
    play(bends([0.1, 0.3, 0.8, 0.3, 0.1], "open"), 0.5); // it is to straighten
    expect(notes).toEqual([2]);
  });

  test("the lake keeps a light for each trial whose note sounded, and takes none away", () => {
    const { play, scene } = played(makeMelody, opposes(0.09));
    const lit = () => scene().children.filter((child) => child.visible && Math.abs(child.position.z + 0.8) < 1e-6).length;
    play(opposes(0.01, 1), 1);
    play({ ...opposes(0.09, 1), phase: "rest", target: { kind: "none" } }, 2);
    expect(lit()).toBe(1);
    play(opposes(0.05, 2), 1); // not reached: nothing is added, nothing is lost
    play({ ...opposes(0.09, 2), phase: "rest", target: { kind: "none" } }, 2);
    expect(lit()).toBe(1);
    play(opposes(0.01, 3, 1), 1);
    play({ ...opposes(0.09, 3), phase: "rest", target: { kind: "none" } }, 2);
    expect(lit()).toBe(2);
  });

  test("a crossing comes once from outside, and a missing number is none", () => {
    const crossing = new Crossing((value) => value >= 0.5, (value) => value < 0.3);
    expect([0.1, 0.6, undefined, 0.4, 0.7, NaN, 0.2, 0.5].map((value) => crossing.take(value))).toEqual([false, true, false, false, false, false, false, true]);
  });

  test("bells are in the order of the fingers as the drawn hand has them", () => {
    const xs = (side: "left" | "right") => {
      const { play, scene } = played(makeMelody, { ...opposes(0.09), side });
      play({ ...opposes(0.09), side }, 1);
      return scene().children.filter((child) => child.children.length === 3 && child.position.y > 4).map((child) => child.position.x); // thumb first
    };
    expect(xs("right")).toHaveLength(5);
    expect([...xs("right")].sort((a, b) => b - a)).toEqual(xs("right"));
    expect(xs("left")).toEqual(xs("right").map((x) => -x || 0));
  });
});

describe("Feel and find", () => {
  const now: Now = { measure: "feel_and_find", hidesScene: true, instruction: "Press slowly until you are told to stop, then let go.", target: { kind: "explore", digits: [1], sponge: 0, depth: 0.003 }, force: [], touching: [] };

  test.each(["feel_and_find", "object_in_hand"])("%s shows and sounds the same for every hand, force, contact and depth", (measure) => {
    const pictures = [0, 1].map((hand) => {
      const { play, scene, game, notes } = played(makeFeel, { ...now, measure });
      const hidden = hand === 0 ? {} : { flexion: [0.9, 0.8, 0.7, 0.6, 0.5], force: [3, 3, 3, 3, 3], touching: [true, true, true, true, true], padDistance: [0, 0, 0, 0], value: 7, valueUnit: "N", forcesOff: true, note: "x", successes: 5, counted: 6, lastSuccess: true };
      for (const phase of ["rest", "trial", "answer"] as const)
        play({ ...now, measure, phase, ...hidden, target: { ...now.target, depth: hand === 0 ? 0.003 : 0.005, sponge: measure === "feel_and_find" ? 0 : -1 } }, 1);
      expect(notes).toEqual([]);
      const picture = pictured(scene(), game.element);
      game.end();
      return picture;
    });
    expect(pictures[1]).toBe(pictures[0]);
  });

  test("the two cloths are alike", () => {
    const { play, scene } = played(makeFeel, now);
    play({ ...now, phase: "rest", target: { kind: "none" } }, 1);
    const covers = scene().children.filter((child) => Math.abs(Math.abs(child.position.x) - 1.75) < 1e-6 && child.children[0]?.type === "Mesh");
    expect(covers).toHaveLength(2);
    const size = (at: number) => covers[at]!.getWorldScale(new Vector3()).toArray();
    expect(size(0)).toEqual(size(1));
  });

  test("the sign to hold comes with the words, and goes with them", () => {
    const { play, game } = played(makeFeel, now);
    const sign = () => game.element.querySelector<HTMLElement>(".hold-sign")!.style.opacity;
    play(now, 0.2);
    expect(sign()).toBe("0");
    play({ ...now, instruction: "Stop, and hold it." }, 0.2);
    expect(sign()).toBe("1");
    play({ ...now, phase: "rest", instruction: "Let go. The second one comes." }, 0.2);
    expect(sign()).toBe("0");
  });

  test("gives back the objects of answers that it no longer shows", () => {
    const { play, scene } = played(makeFeel, { ...now, measure: "object_in_hand" });
    const asks = (choices: readonly string[]) => play({ ...now, measure: "object_in_hand", choices }, 0.2);
    asks(["a ball", "a cube"]);
    let given = 0;
    const watched: BufferGeometry[] = [];
    scene().traverse((object) => {
      const { geometry } = object as Mesh;
      if (geometry?.type === "SphereGeometry" || geometry?.type === "BoxGeometry") watched.push(geometry);
    });
    for (const geometry of watched) geometry.addEventListener("dispose", () => ++given);
    asks(["a cylinder"]);
    expect(given).toBeGreaterThan(1);
  });

  test("objects have shapes by their names; an unknown one is a stone", () => {
    expect(["a ball", "a cube", "a cylinder", "a pear"].map(shapeOf)).toEqual(["ball", "cube", "cylinder", "stone"]);
  });
});

describe("motion", () => {
  test("the lantern goes from one shore to the other", () => {
    expect(arcAt(0).x).toBeLessThan(-2.5);
    expect(arcAt(1).x).toBeGreaterThan(2.5);
    expect(arcAt(0.5).y).toBeGreaterThan(arcAt(0).y + 2);
  });

  test("each petal follows its own digit", () => {
    const now: Now = { measure: "range_of_motion", target: { kind: "open", digits: [0, 1, 2, 3, 4] }, flexion: [0, 0, 0, 0, 0] };
    const { play, scene } = played(makeFlower, now);
    play(now, 2);
    const before = pictured(scene());
    play({ ...now, flexion: [0, 0, 0, 0.9, 0] }, 2);
    expect(pictured(scene())).not.toBe(before);
    play(now, 6);
    const flower = scene().children.find((child) => child.children.length === 13)!;
    expect(flower.children[12]!.children[0]!.rotation.x).toBeCloseTo(0.1, 3); // little finger, open
    play({ ...now, flexion: [0, 0, 0, 0, 1] }, 4);
    expect(flower.children[12]!.children[0]!.rotation.x).toBeCloseTo(0.6, 3);
    expect(flower.children[8]!.children[0]!.rotation.x).toBeCloseTo(0.1, 3); // thumb
  });
});
