// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it } from "vitest";
import { IdleLock } from "../../../src/people/idle";

let now = 0;
let locks = 0;
let alive = 0;
let idle: IdleLock;

beforeEach(() => {
  now = locks = alive = 0;
  idle = new IdleLock(() => now, () => ++locks, () => ++alive);
  idle.begin({ lockMs: 1000, aliveMs: 300 });
});

describe("the lock by time", () => {
  it("comes once, after the time without input", () => {
    now = 999;
    expect(idle.check()).toBe(false);
    now = 1000;
    expect(idle.check()).toBe(true);
    now = 5000;
    expect(idle.check()).toBe(false);
    expect(locks).toBe(1);
  });

  it("is put off by each input, and the station is told now and then that the person is there", () => {
    for (now = 100; now <= 3000; now += 100) {
      idle.input();
      idle.check();
    }
    expect(locks).toBe(0);
    expect(alive).toBe(10);
  });

  it("locks a computer that slept before its first input counts", () => {
    now = 1_000_000;
    idle.input();
    expect(locks).toBe(1);
    expect(alive).toBe(0);
  });

  it("rests while no session is open", () => {
    idle.end();
    now = 5000;
    idle.input();
    expect(idle.check()).toBe(false);
    expect([locks, alive]).toEqual([0, 0]);
    idle.begin({ lockMs: 1000, aliveMs: 300 });
    now = 5999;
    expect(idle.check()).toBe(false);
  });
});
