// SPDX-License-Identifier: Apache-2.0
// Soft lights of the games: whatever a hand does, each of them flashes at most three times a second.
import type { Sprite } from "three";
import { beforeAll, describe, expect, test } from "vitest";
import { kMostFlashes } from "../../../../src/patient/flash_guard";
import { makeMelody } from "../../../../src/patient/games/melody";
import { makeBalloon, makeFountain, makePinch } from "../../../../src/patient/games/press";
import { makeFlower } from "../../../../src/patient/games/range";
import { makeReach } from "../../../../src/patient/games/reach_line";
import { river } from "../../../../src/patient/games/river";
import type { MakeGame } from "../../../../src/patient/game";
import { fakePens, lightOf, lightsOf, mostInASecond } from "./flashes";
import { exercise, played, type Now } from "./playing";

const kFrames = 30; // a second
const kSeconds = 1; // at each rate
const kRates = [2, 4, 7]; // of a hand that shakes [Hz]

/// What a shaking hand does: `on` is one end of the shaking.
interface Shaken {
  readonly name: string;
  readonly make: MakeGame;
  readonly now: (on: boolean, beat: number) => Now;
}

const far = [0.09, 0.09, 0.09, 0.09];
const force = { kind: "force", digits: [1], low: 1.7, high: 2.3 } as const;
const shaken: readonly Shaken[] = [
  { name: "the balloon", make: makeBalloon, now: (on) => ({ measure: "press_and_hold", target: force, value: on ? 2 : 0.2 }) },
  { name: "the fountain", make: makeFountain, now: (on) => ({ measure: "squeeze_release", target: { kind: on ? "squeeze" : "open", digits: [1] }, value: on ? 9 : 0 }) },
  { name: "the bubble", make: makePinch, now: (on) => ({ measure: "pinch", target: { ...force, digits: [0, 1] }, value: on ? 2 : 0.2, touching: [on, on, false, false, false] }) },
  { name: "the flower", make: makeFlower, now: (on) => ({ measure: "range_of_motion", target: { kind: on ? "open" : "close", digits: [0, 1, 2, 3, 4] }, flexion: on ? [0, 0, 0, 0, 0] : [1, 1, 1, 1, 1] }) },
  { name: "the lantern", make: makeReach, now: (on) => ({ measure: "smoothness", target: { kind: "angle", digits: [1], flexion: [undefined, 0.7, undefined, undefined, undefined] }, flexion: [0.2, on ? 0.7 : 0.1, 0.2, 0.2, 0.2] }) },
  { name: "the melody of touches", make: makeMelody, now: (on) => ({ measure: "opposition", target: { kind: "touch", digits: [0, 2] }, padDistance: far.map((one, at) => (at === 1 && on ? 0.01 : one)) }) },
  { name: "the melody of fingers", make: makeMelody, now: (on, beat) => ({ measure: "independence", trial: 1 + (beat % 8), target: { kind: "close", digits: [2] }, flexion: [0.1, 0.1, on ? 0.9 : 0.1, 0.1, 0.1] }) },
  { name: "the river at a band", make: river, now: (on) => ({ measure: "press_and_hold", training: true, target: force, value: on ? 2 : 0.2 }) },
  { name: "the river with a moving lane", make: river, now: (on) => ({ measure: "force_tracking", training: true, target: { ...force, low: on ? 1 : 2.5, high: on ? 1.6 : 3.1 }, value: 2 }) },
  { name: "the river of squeezes", make: river, now: (on, beat) => ({ measure: "squeeze_release", training: true, target: { kind: on ? "squeeze" : "open", digits: [1] }, value: on ? 6 : 0, counted: beat, successes: beat, lastSuccess: true }) },
];

beforeAll(fakePens);

describe.each(shaken)("the soft lights of $name", ({ make, now }) => {
  test("flash at most three times a second, however fast a hand shakes", () => {
    const { game, scene } = played(make, now(false, 0));
    const seen = new Map<Sprite, number[]>();
    const sums: number[] = [];
    let beats = 0;
    for (const rate of kRates)
      for (let frame = 0; frame < kFrames * kSeconds; ++frame) {
        const on = (frame * rate) % kFrames < kFrames / 2;
        beats += Number((frame * rate) % kFrames < rate);
        game.show(exercise(now(on, beats)), 1 / kFrames);
        const lights = lightsOf(scene()).map((sprite) => [sprite, lightOf(sprite)] as const);
        for (const [sprite, light] of lights) {
          if (!seen.has(sprite)) seen.set(sprite, sums.map(() => 0)); // a lantern that rises later
          seen.get(sprite)!.push(light);
        }
        sums.push(lights.reduce((sum, [, light]) => sum + light, 0));
      }
    expect(seen.size, "the game has soft lights").toBeGreaterThan(0);
    const full = Math.max(...[...seen.values()].flat());
    expect(full, "one of them is seen").toBeGreaterThan(0.01);
    const most = Math.max(...[...seen.values()].map((values) => mostInASecond(values, kFrames, full)));
    expect(most, "of one light").toBeLessThanOrEqual(kMostFlashes);
    expect(mostInASecond(sums, kFrames), "of all lights together").toBeLessThanOrEqual(kMostFlashes);
    game.end();
  });
});

test("counting finds a light that flashes", () => {
  const at = (rate: number) => Array.from({ length: 4 * kFrames }, (_, frame) => ((frame * rate) % kFrames < kFrames / 2 ? 1 : 0));
  expect(mostInASecond(at(2), kFrames)).toBeLessThanOrEqual(kMostFlashes);
  expect(mostInASecond(at(5), kFrames)).toBeGreaterThan(kMostFlashes);
});
