// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { readCourse } from "../../../src/people/shapes";
import { niceTicks, trendFigure } from "../../../src/people/trend_chart";
import { words } from "../../../src/people/words";

const day = 86_400;
const trend = (fields: Readonly<Record<string, unknown>>) => readCourse({ trends: [fields] }).trends[0]!;
const grip = {
  name: "grip/more_affected", title: "Grip", unit: "kg", entered: true, proven: true, verdict: "improved: +4 kg from ...; Chen et al. 2009", smallest_real_difference: 2.9,
  points: [{ date: 100 * day, value: 20 }, { date: 110 * day, value: 22 }, { date: 120 * day, value: 24 }],
};
const number = (element: Element, name: string) => Number(element.getAttribute(name));

describe("the chart of a trend", () => {
  it("has a point for each value, and a band of the smallest real difference around the first one", () => {
    const figure = trendFigure(trend(grip), []);
    const [first, , last] = [...figure.querySelectorAll("circle")].map((one) => [number(one, "cx"), number(one, "cy")] as const);
    const band = figure.querySelector(".trend-band")!;
    const scale = (first![1] - last![1]) / 4; // pixels for each kg
    expect(scale).toBeGreaterThan(0);
    expect(number(band, "y")).toBeCloseTo(first![1] - 2.9 * scale, 0);
    expect(number(band, "height")).toBeCloseTo(2 * 2.9 * scale, 0);
    expect(last![1], "a proven change lies outside of the band").toBeLessThan(number(band, "y"));
    expect(figure.querySelectorAll("circle").length).toBe(3);
    expect(figure.textContent).toContain(words.trends.band("2.9 kg"));
    expect(figure.textContent).toContain(words.trends.judged(words.verdicts["improved"]!, "+4 kg"));
  });

  it("says in words what it shows", () => {
    const said = trendFigure(trend(grip), []).querySelector("svg")!.getAttribute("aria-label")!;
    for (const text of [words.kinds["grip"]!, "20 kg", "24 kg", words.verdicts["improved"]!]) expect(said).toContain(text);
  });

  it("has no band where no difference is published", () => {
    const figure = trendFigure(trend({ name: "press/mean_n", title: "press: mean_n", unit: "N", verdict: "change not proven: x", points: grip.points }), []);
    expect(figure.querySelector(".trend-band, .trend-first")).toBeNull();
    expect(figure.textContent).toContain(words.trends.noBand);
    expect(figure.querySelector("figcaption")!.textContent).toContain("press: mean");
  });

  it.each([[[5]], [[5, 5]], [[0, 0]], [Array.from({ length: 200 }, (_, i) => i % 7)]])("of values %j has finite places alone", (values) => {
    const figure = trendFigure(trend({ name: "a/b", title: "t", unit: "s", verdict: "v", points: values.map((value, i) => ({ date: (i + 1) * day, value })) }), []);
    expect(figure.innerHTML).not.toMatch(/NaN|Infinity/);
  });

  it("has steps of 1, 2 or 5 times a power of ten", () => {
    expect(niceTicks(14.1, 27.9, 2)).toEqual([15, 20, 25]);
    expect(niceTicks(0, 1, 2)).toEqual([0, 0.5, 1]);
    expect(niceTicks(3, 3, 2)).toEqual([3]);
  });
});
