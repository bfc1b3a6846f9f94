// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from "vitest";
import { DrawnHand, demonstrated, demonstratedPose, makeDemonstration, opposed, wave } from "../../../../src/patient/demonstration";
import { digitPath, handShape } from "../../../../src/patient/hand_shape";
import { exercise } from "./playing";

const open = [0, 0, 0, 0, 0];
const only = (digit: number, value: number) => open.map((_, at) => (at === digit ? value : 0));
const length = (flexion: readonly number[], digit: number) => {
  const { beads } = handShape({ flexion })[digit]!;
  return Math.hypot(beads[3]!.x - beads[0]!.x, beads[3]!.y - beads[0]!.y);
};

describe("the drawn hand", () => {
  test("each digit bends alone: its tip moves, the others stay", () => {
    for (let digit = 0; digit < 5; ++digit) {
      const before = handShape({ flexion: open });
      const after = handShape({ flexion: only(digit, 0.6) });
      before.forEach((shape, at) => {
        const moved = Math.hypot(after[at]!.beads[3]!.x - shape.beads[3]!.x, after[at]!.beads[3]!.y - shape.beads[3]!.y);
        if (at === digit) expect(moved).toBeGreaterThan(25);
        else expect(moved).toBe(0);
      });
    }
  });

  test("a finger's tip goes down steadily as it bends, past its base in a fist", () => {
    for (let digit = 1; digit < 5; ++digit) {
      const tips = Array.from({ length: 11 }, (_, at) => handShape({ flexion: only(digit, at / 10) })[digit]!.beads[3]!.y);
      for (let at = 1; at < tips.length; ++at) expect(tips[at]! - tips[at - 1]!).toBeGreaterThan(-2);
      expect(tips[10]! - tips[0]!).toBeGreaterThan(100);
      expect(tips[10]!).toBeGreaterThan(handShape({ flexion: open })[digit]!.beads[0]!.y);
      expect(length(open, digit)).toBeGreaterThan(100);
    }
  });

  test("the thumb reaches the tip of every finger", () => {
    for (let finger = 1; finger < 5; ++finger) {
      const shapes = handShape({ flexion: open, oppose: { finger, amount: 1 } });
      const [thumb, tip] = [shapes[0]!.beads[3]!, shapes[finger]!.beads[3]!];
      expect(Math.hypot(thumb.x - tip.x, thumb.y - tip.y)).toBeLessThan(thumb.r + tip.r);
      const apart = handShape({ flexion: open, oppose: { finger, amount: 0 } });
      expect(Math.hypot(apart[0]!.beads[3]!.x - apart[finger]!.beads[3]!.x, apart[0]!.beads[3]!.y - apart[finger]!.beads[3]!.y)).toBeGreaterThan(100);
    }
  });

  test("numbers that are missing, or beyond open and closed, are drawn as the nearest pose", () => {
    expect(handShape({ flexion: [] })).toEqual(handShape({ flexion: open }));
    expect(handShape({ flexion: [NaN, -3, NaN, NaN, NaN] })).toEqual(handShape({ flexion: open }));
    expect(handShape({ flexion: [2, 2, 2, 2, 2] })).toEqual(handShape({ flexion: [1, 1, 1, 1, 1] }));
    for (let step = 0; step <= 20; ++step) for (const shape of handShape({ flexion: [1, 1, 1, 1, 1].map((value) => (value * step) / 20) })) expect(digitPath(shape)).not.toMatch(/NaN/);
  });

  test("a left hand is the mirror image", () => {
    expect(new DrawnHand("left").element.querySelector("g")!.getAttribute("transform")).toContain("scale(-1 1)");
    expect(new DrawnHand("right").element.querySelector("g")!.getAttribute("transform")).toBeNull();
  });

  test("an instructed digit has a thicker line and a dot beside its colour", () => {
    const hand = new DrawnHand("right");
    const group = (digit: number) => hand.element.querySelector(`[data-digit-of-hand="${digit}"]`)!;
    hand.mark([2]);
    const width = (digit: number) => Number(group(digit).querySelector("path")!.getAttribute("stroke-width"));
    expect(width(2)).toBeGreaterThan(1.3 * width(1));
    expect(group(2).querySelector("circle")!.getAttribute("visibility")).toBe("visible");
    expect(group(1).querySelector("circle")!.getAttribute("visibility")).toBe("hidden");
    hand.mark([]);
    expect(width(2)).toBe(width(1));
  });
});

describe("demonstration", () => {
  test("each measure has its movement", () => {
    const movement = (measure: string, kind: Parameters<typeof exercise>[0] = {}) => demonstrated(exercise({ measure, ...kind })).movement;
    expect(movement("opposition")).toBe("touch");
    expect(movement("independence")).toBe("one_finger");
    expect(movement("independence", { target: { kind: "open", digits: [1] } })).toBe("straighten");
    expect(movement("squeeze_release", { target: { kind: "squeeze", digits: [1] } })).toBe("squeeze");
    expect(movement("squeeze_release", { target: { kind: "open", digits: [1] } })).toBe("let_go");
    expect(movement("range_of_motion", { target: { kind: "open" } })).toBe("open");
    expect(movement("entry_check", { target: { kind: "close" } })).toBe("close");
    expect(movement("total_active_motion")).toBe("open_close");
    expect(movement("feel_and_find")).toBe("explore");
  });

  test("a movement begins and ends at rest, without a jump", () => {
    expect(wave(0)).toBe(0);
    expect(wave(0.5)).toBe(1);
    expect(wave(0.9999)).toBeCloseTo(0, 3);
    for (let at = 1; at <= 1000; ++at) expect(Math.abs(wave(at / 1000) - wave((at - 1) / 1000))).toBeLessThan(0.006);
    const touching = demonstratedPose({ movement: "touch", digits: [0, 4] }, 2.25).pose.oppose;
    expect(touching).toEqual({ finger: 4, amount: 1 });
  });

  test("with reduced motion it shows begin and end of the movement alone", () => {
    const shown = new Set<string>();
    const hand = makeDemonstration(() => true);
    for (let frame = 0; frame < 300; ++frame) {
      hand.show(exercise({ measure: "range_of_motion", target: { kind: "close", digits: [1, 2, 3, 4] } }), 1 / 30, false);
      shown.add([...hand.element.querySelectorAll("path")].map((path) => path.getAttribute("d")).join(" "));
    }
    expect(shown.size).toBe(2);
  });

  test("it mirrors the patient's own hand, and the thumb's way to the instructed finger", () => {
    const hand = makeDemonstration();
    const own = (flexion: readonly number[]) => {
      hand.show(exercise({ measure: "range_of_motion", flexion }), 1 / 30, true);
      return hand.element.innerHTML;
    };
    expect(own([0, 0, 0, 0, 0])).not.toBe(own([0, 0.9, 0, 0, 0]));
    const touch = { movement: "touch", digits: [0, 2] } as const;
    expect(opposed(touch, [0.09, 0.012, 0.09, 0.09])).toEqual({ finger: 2, amount: 1 });
    expect(opposed(touch, [0.01, 0.09, 0.09, 0.09])).toEqual({ finger: 2, amount: 0 });
    expect(opposed(touch, [])).toBeUndefined();
  });

  test("while the scene is hidden it never shows the patient's own hand", () => {
    const pictures = [[0, 0, 0, 0, 0], [0.9, 0.9, 0.9, 0.9, 0.9]].map((flexion) => {
      const hand = makeDemonstration();
      hand.show(exercise({ measure: "object_in_hand", hidesScene: true, flexion }), 1 / 30, true);
      return hand.element.innerHTML;
    });
    expect(pictures[0]).toBe(pictures[1]);
  });
});
