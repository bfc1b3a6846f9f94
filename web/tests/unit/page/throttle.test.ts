// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Throttle } from "../../../src/state/throttle";

describe("Throttle", () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it("sends the first at once, at most ten a second, and the last for sure", () => {
    const sent: { value: number; at: number }[] = [];
    const throttle = new Throttle<number>((value) => sent.push({ value, at: performance.now() }), 10);
    for (let i = 0; i <= 100; ++i) {
      throttle.push(i);
      vi.advanceTimersByTime(10);
    }
    vi.advanceTimersByTime(1000);
    expect(sent[0]?.value).toBe(0);
    expect(sent.at(-1)?.value).toBe(100);
    for (let i = 1; i < sent.length; ++i) expect(sent[i]!.at - sent[i - 1]!.at).toBeGreaterThanOrEqual(100);
    expect(sent.length).toBeGreaterThanOrEqual(10);
    expect(sent.length).toBeLessThanOrEqual(12);
  });

  it("flush sends what waits, once, and nothing where nothing waits", () => {
    const sent: string[] = [];
    const throttle = new Throttle<string>((value) => sent.push(value), 10);
    throttle.push("a");
    throttle.push("b");
    throttle.flush();
    throttle.flush();
    vi.advanceTimersByTime(1000);
    expect(sent).toEqual(["a", "b"]);
  });
});
