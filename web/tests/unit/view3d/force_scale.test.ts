// SPDX-License-Identifier: Apache-2.0
import { PerspectiveCamera } from "three";
import { describe, expect, it } from "vitest";
import { apart, ForceLabels, placedLabels } from "../../../src/view3d/force_labels";
import { arrowLength, forceScale, isAtLimit, shareOf } from "../../../src/view3d/force_scale";

describe("the scale of forces", () => {
  it("ends at the limit of a digit, and at a stated force where there is none", () => {
    expect(forceScale(5)).toEqual({ end: 5, limit: 5 });
    for (const none of [Infinity, NaN, 0, -1]) expect(forceScale(none)).toEqual({ end: 10, limit: Infinity });
  });
  it("is the same for bars and arrows", () => {
    for (const limit of [1, 5, 15, Infinity]) {
      const scale = forceScale(limit);
      const longest = arrowLength(scale, scale.end);
      for (const newtons of [0, 0.3 * scale.end, 0.7 * scale.end, scale.end, 2 * scale.end]) {
        expect(arrowLength(scale, newtons)).toBeCloseTo(longest * shareOf(scale, newtons), 12);
      }
      expect(shareOf(scale, 100)).toBe(1);
    }
    for (const none of [0, -1, NaN]) expect(arrowLength(forceScale(5), none)).toBe(0);
  });
  it("is at the limit where the figure is", () => {
    expect([4.9, 4.94, 4.96, 5, 7].map((newtons) => isAtLimit(forceScale(5), newtons))).toEqual([false, false, true, true, true]);
    expect(isAtLimit(forceScale(Infinity), 1000)).toBe(false);
  });
});

describe("figures at the arrows' tips", () => {
  it("do not lie over each other (seed 3)", () => {
    let seed = 3;
    const random = (): number => (seed = (seed * 16807) % 2147483647) / 2147483647;
    for (let round = 0; round < 50; ++round) {
      const placed = apart(Array.from({ length: 8 }, () => ({ left: 60 * random(), top: 60 * random(), width: 40 })));
      placed.forEach((a, i) =>
        placed.slice(0, i).forEach((b) => {
          const overlap = a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + 17 - 1e-9 && b.top < a.top + 17 - 1e-9;
          expect(overlap).toBe(false);
        }),
      );
    }
  });
  it("are where the tips are seen, and nowhere for what is behind the camera", () => {
    const camera = new PerspectiveCamera(90, 1, 0.01, 10);
    camera.updateMatrixWorld();
    const labels = new ForceLabels();
    labels.show(placedLabels([{ text: "1 N", tip: [0, 0, -1], felt: true }, { text: "2 N", tip: [0, 0, 1], felt: true }], camera, 200, 100));
    const seen = () => [...labels.element.querySelectorAll("span")].filter((span) => !span.hidden);
    expect(seen().map((span) => span.textContent)).toEqual(["1 N"]);
    expect(seen()[0]!.style.transform).toBe("translate(106.0px, 41.5px)");
    labels.show([]);
    expect(seen()).toEqual([]);
  });
});
