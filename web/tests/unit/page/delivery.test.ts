// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { Delivery } from "../../../src/state/delivery";

const tick = (time: number, step = 0n) => create(TickSchema, { time, tick: step });

describe("how pictures arrive", () => {
  it("counts those that came and those that are missing, and how much later than the fastest they were", () => {
    const delivery = new Delivery();
    let missing = 0;
    for (let i = 0; i < 600; ++i) {
      if (i % 100 === 50) {
        ++missing;
        continue;
      }
      delivery.feed(tick(100 + i / 60), 7 + i / 60 + (i % 10 === 0 ? 0.03 : 0.002)); // every tenth is late by 28 ms
    }
    const figures = delivery.figures(7 + 600 / 60);
    expect(figures.missing).toBe(missing);
    expect(figures.perSecond).toBeCloseTo(59.4, 0);
    expect(figures.delay.p50).toBeCloseTo(0, 9);
    expect(figures.delay.p99).toBeCloseTo(0.028, 6);
  });

  it("speaks of the last 10 s alone, and keeps no more", () => {
    const delivery = new Delivery();
    for (let i = 0; i < 60 * 600; ++i) delivery.feed(tick(i / 60), i / 60 + (i < 60 * 300 ? 0.2 * (i % 2) : 0));
    expect(delivery.figures(600).delay.p99).toBeCloseTo(0, 9);
    expect(delivery.figures(700)).toEqual({ perSecond: 0, missing: 0, delay: { p50: NaN, p99: NaN } });
  });

  it("begins again with another station's clock", () => {
    const delivery = new Delivery();
    delivery.feed(tick(500), 1);
    delivery.feed(tick(500), 1.5); // the same step again
    delivery.feed(tick(3), 2);
    delivery.feed(tick(3 + 1 / 60), 2 + 1 / 60);
    expect(delivery.figures(2.1).missing).toBe(0);
  });

  it("counts no gap while the station changes, or before another one's first step", () => {
    const delivery = new Delivery();
    delivery.feed(tick(1, 1000n), 1);
    delivery.rest();
    delivery.feed(tick(3, 3000n), 3);
    expect(delivery.figures(3).missing).toBe(0);
    delivery.feed(tick(5, 1n), 5);
    expect(delivery.figures(5).missing).toBe(0);
    delivery.feed(tick(6, 1000n), 6); // at work all the time
    expect(delivery.figures(6).missing).toBe(59);
  });
});
