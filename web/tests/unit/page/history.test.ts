// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { toCsv } from "../../../src/state/csv";
import { History } from "../../../src/state/history";
import { random } from "./random";

describe("History", () => {
  it("is a plain list's last entries, whatever is pushed", () => {
    const seed = 20261122;
    const next = random(seed);
    const history = new History(3, 7);
    const list: { time: number; row: number[] }[] = [];
    let time = 0;
    for (let i = 0; i < 200; ++i) {
      time += 0.001 + next();
      const row = [next(), -next(), 100 * next()].map(Math.fround);
      history.push(time, row);
      list.push({ time, row });
      const last = list.slice(-7);
      expect([...history.time()], `seed ${seed}, push ${i}`).toEqual(last.map((one) => one.time));
      for (let channel = 0; channel < 3; ++channel) {
        expect([...history.channel(channel)]).toEqual(last.map((one) => one.row[channel]));
      }
      expect(history.end).toBe(time);
    }
  });

  it("takes its storage once", () => {
    const history = new History(2, 4);
    const storage = history.channel(1).buffer;
    for (let i = 1; i < 50; ++i) history.push(i, [i, -i]);
    expect(history.channel(1).buffer).toBe(storage);
    expect(history.length).toBe(4);
  });

  it("ignores a step that it has, and begins anew when the clock runs backwards", () => {
    const history = new History(1, 4);
    history.push(1, [10]);
    history.push(1, [11]);
    expect([...history.channel(0)]).toEqual([10]);
    history.push(2, [20]);
    history.push(0.5, [5]);
    expect([...history.time()]).toEqual([0.5]);
    expect([...history.channel(0)]).toEqual([5]);
  });

  it("is empty at first and refuses a channel that it has not", () => {
    const history = new History(1, 4);
    expect(history.time().length).toBe(0);
    expect(history.end).toBeNaN();
    expect(() => history.channel(1)).toThrow(RangeError);
    expect(history.nearest(3)).toBe(-1);
  });

  it("finds samples by their times, also after it has wrapped", () => {
    const history = new History(1, 5);
    for (let time = 1; time <= 8; ++time) history.push(time, [time]);
    expect([3, 4, 4.2, 8, 8.1].map((time) => history.firstFrom(time))).toEqual([0, 0, 1, 4, 5]);
    expect([0, 4.4, 4.6, 99].map((time) => history.time()[history.nearest(time)])).toEqual([4, 4, 5, 8]);
  });
});

describe("toCsv", () => {
  it("writes a head with units, times from zero, and leaves unknown values empty", () => {
    const history = new History(2, 4);
    history.push(100, [0.1, NaN]);
    history.push(100.0167, [-2, 1e-5]);
    const text = toCsv(history, 90, 101, [
      { name: "force_raw index tip", unit: "N" },
      { name: 'odd, "name"', unit: "rad" },
    ]);
    expect(text).toBe('time [s],station_time [s],force_raw index tip [N],"odd, ""name"" [rad]"\r\n0.0000,100.0000,0.1,\r\n0.0167,100.0167,-2,0.00001\r\n');
  });

  it("holds no more than the time that is asked for", () => {
    const history = new History(1, 8);
    for (const time of [1, 2, 11, 12, 13]) history.push(time, [time]);
    const rows = toCsv(history, 11, 12, [{ name: "a", unit: "N" }]).trimEnd().split("\r\n").slice(1);
    expect(rows).toEqual(["0.0000,11.0000,11", "1.0000,12.0000,12"]);
  });

  it("scales values, and writes names for numbers", () => {
    const history = new History(2, 4);
    history.push(1, [Math.PI, 1]);
    const text = toCsv(history, 0, 2, [{ name: "angle", unit: "deg", scale: 180 / Math.PI }, { name: "scene", unit: "", text: (value) => ["a", "b, c"][value]! }]);
    expect(text).toBe('time [s],station_time [s],angle [deg],scene\r\n0.0000,1.0000,180,"b, c"\r\n');
  });

  it("is only a head where there is nothing", () => {
    expect(toCsv(new History(1, 2), 0, 10, [{ name: "a", unit: "N" }])).toBe("time [s],station_time [s],a [N]\r\n");
  });
});
