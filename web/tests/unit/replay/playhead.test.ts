// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { Playhead, speeds } from "../../../src/replay/playhead";

/// Frames every 20 ms for so many seconds of the page's clock.
function run(playhead: Playhead, seconds: number, from = 0, held = false): number {
  let now = from;
  playhead.frame(now, held);
  for (; now < from + 1000 * seconds; now += 20) playhead.frame(now + 20, held);
  return now;
}

describe("the playhead", () => {
  it("moves with the page's clock at its speed, and stands while it is paused", () => {
    const playhead = new Playhead(100);
    let now = run(playhead, 2);
    expect(playhead.position).toBe(0);
    playhead.play();
    now = run(playhead, 2, now);
    expect(playhead.position).toBeCloseTo(2, 6);
    playhead.setSpeed(0.25);
    now = run(playhead, 4, now);
    expect(playhead.position).toBeCloseTo(3, 6);
    playhead.setSpeed(4);
    now = run(playhead, 1, now);
    expect(playhead.position).toBeCloseTo(7, 6);
    playhead.pause();
    run(playhead, 1, now);
    expect(playhead.position).toBeCloseTo(7, 6);
  });

  it("waits for what is not loaded, and does not leap afterwards", () => {
    const playhead = new Playhead(100);
    playhead.play();
    const now = run(playhead, 5, 0, true);
    expect(playhead.position).toBe(0);
    run(playhead, 1, now);
    expect(playhead.position).toBeCloseTo(1, 6);
  });

  it("does not leap when the page slept, nor when it begins to play after a pause", () => {
    const playhead = new Playhead(1000);
    playhead.play();
    playhead.frame(0);
    playhead.frame(60_000);
    expect(playhead.position).toBeLessThan(0.3);
    playhead.pause();
    playhead.frame(61_000);
    const at = playhead.position;
    playhead.play();
    playhead.frame(90_000);
    expect(playhead.position).toBe(at);
  });

  it("stops at the end, and begins again from there", () => {
    const playhead = new Playhead(1);
    playhead.play();
    const now = run(playhead, 2);
    expect(playhead.playing).toBe(false);
    expect(playhead.position).toBe(1);
    playhead.play();
    run(playhead, 0.5, now);
    expect(playhead.position).toBeCloseTo(0.5, 6);
  });

  it("stays within the recording, whatever time it is sent to", () => {
    const playhead = new Playhead(10);
    for (const [wanted, is] of [[-3, 0], [11, 10], [NaN, 0], [4.2, 4.2]] as const) {
      playhead.seek(wanted);
      expect(playhead.position).toBe(is);
    }
  });

  it("goes through its speeds and no farther", () => {
    const playhead = new Playhead(10);
    for (let i = 0; i < 10; ++i) playhead.faster(1);
    expect(playhead.speed).toBe(speeds.at(-1));
    for (let i = 0; i < 10; ++i) playhead.faster(-1);
    expect(playhead.speed).toBe(speeds[0]);
  });
});
