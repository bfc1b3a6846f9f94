// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { highestQuality, pixelRatioFor, QualityWatch, qualityLevels } from "../../../src/view3d/quality";

/// Frames of that length for so long; the level after it.
function run(watch: QualityWatch, frame: number, seconds: number): number {
  for (let time = 0; time < seconds; time += frame) watch.frame(frame);
  return watch.level;
}

/// When it goes up while frames are slow where `slow` [s].
function upsWithin(watch: QualityWatch, seconds: number, slow: (time: number) => boolean): number[] {
  const ups: number[] = [];
  for (let time = 0; time < seconds; ) {
    const before = watch.level;
    const frame = slow(time) ? 1 / 15 : 1 / 60;
    watch.frame(frame);
    time += frame;
    if (watch.level > before) ups.push(time);
  }
  return ups;
}

describe("QualityWatch", () => {
  it("stays at the top while frames are fast", () => {
    expect(run(new QualityWatch(), 1 / 60, 60)).toBe(highestQuality);
  });
  it("stays where it is between slow and fast", () => {
    expect(run(new QualityWatch(2), 1 / 30, 120)).toBe(2);
  });
  it("goes down one level at a time at 15 frames a second", () => {
    const watch = new QualityWatch();
    const levels = [watch.level];
    for (let i = 0; i < 200; ++i) if (watch.frame(1 / 15)) levels.push(watch.level);
    expect(levels).toEqual([3, 2, 1, 0]);
  });
  it("goes down by two within ten frames at 2 frames a second", () => {
    const watch = new QualityWatch();
    for (let i = 0; i < 10; ++i) watch.frame(0.5);
    expect(watch.level).toBe(1);
  });
  it("does not go below zero nor above the top", () => {
    expect(run(new QualityWatch(0), 0.5, 60)).toBe(0);
    expect(run(new QualityWatch(99), 1 / 60, 60)).toBe(highestQuality);
  });
  it("goes up again when frames have been fast for a while, not at once", () => {
    const watch = new QualityWatch(1);
    expect(run(watch, 1 / 60, 4)).toBe(1);
    expect(run(watch, 1 / 60, 8)).toBe(2);
  });
  it("tries three times, waiting longer each time, where one level is fast and the next too slow; then it stays down for good", () => {
    const watch = new QualityWatch(1);
    const ups = upsWithin(watch, 3600, () => watch.level >= 2);
    const waits = ups.slice(1).map((at, i) => at - ups[i]!);
    expect(waits.length).toBe(2);
    expect(waits[1]!).toBeGreaterThan(1.5 * waits[0]!);
    expect(watch.level).toBe(1);
  });
  it("does not count it against a level that the machine was busy for a while, an hour after the step up", () => {
    const watch = new QualityWatch(1);
    const ups = upsWithin(watch, 6 * 3600, (time) => watch.level >= 2 && time % 3600 < 5);
    expect(ups.length).toBeGreaterThan(6);
    expect(watch.level).toBeGreaterThan(1);
  });
  it("does not judge by one long pause", () => {
    const watch = new QualityWatch();
    for (let i = 0; i < 100; ++i) {
      watch.frame(1 / 60);
      if (i % 10 === 0) watch.frame(30);
    }
    expect(watch.level).toBe(highestQuality);
  });
});

describe("pixelRatioFor", () => {
  it("is never more than the screen's, the level's or what the area allows", () => {
    const best = qualityLevels[highestQuality]!;
    expect(pixelRatioFor(best, 800, 600, 1)).toBe(1);
    expect(pixelRatioFor(best, 800, 600, 3)).toBe(best.pixelRatio);
    const worst = qualityLevels[0]!;
    const ratio = pixelRatioFor(worst, 1600, 1000, 2);
    expect(1600 * 1000 * ratio * ratio).toBeCloseTo(worst.pixels, 0);
  });
});
