// SPDX-License-Identifier: Apache-2.0
// Where the skin has creases and nails.
import { Matrix4, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { nailsOn } from "../../../src/view3d/nails";
import { palmLines } from "../../../src/view3d/palm_lines";
import { kPalm, kSegments } from "../../../src/view3d/segments";
import { boundHand, isTip, phaseAt } from "../../../src/view3d/skin_detail";

const tips = [2, 5, 8, 11, 14];

describe("the phase along a digit", () => {
  it("rises steadily along a finger, with whole numbers at its root crease and its joints", () => {
    expect(phaseAt(kPalm, 0.3)).toBe(0.5);
    const along = [3, 4, 5].flatMap((segment) => [0, 0.25, 0.5, 0.75, 0.999].map((share) => phaseAt(segment, share)));
    along.slice(1).forEach((phase, i) => expect(phase).toBeGreaterThanOrEqual(along[i]!));
    expect([phaseAt(3, 0.5), phaseAt(4, 0), phaseAt(5, 0)]).toEqual([1, 2, 3]);
    expect(phaseAt(3, 1)).toBe(2);
    expect(phaseAt(5, 1)).toBeLessThan(3.5); // no crease at the tip
  });
  it("falls along the thumb, whose end joint is -1", () => {
    expect([phaseAt(0, 0.5), phaseAt(1, 0), phaseAt(1, 1), phaseAt(2, 0)]).toEqual([-0.5, -0.5, -1, -1]);
    expect(phaseAt(2, 1)).toBeGreaterThan(-1.5);
  });
});

describe("nails", () => {
  const length = 0.024;
  const radius = 0.008;

  /// Tips as half cylinders along -z with the back at +y; the frames stand beside each other.
  function fingertips(): { position: number[]; index: number[]; owner: number[]; frames: Matrix4[] } {
    const frames = Array.from({ length: kSegments }, (_, i) => new Matrix4().makeRotationZ(0.1 * i).setPosition(0.05 * i, 0, 0));
    const made = { position: [] as number[], index: [] as number[], owner: [] as number[], frames };
    const kAround = 24;
    for (const segment of tips) {
      const first = made.owner.length;
      for (let ring = 0; ring <= 10; ++ring) {
        for (let i = 0; i <= kAround; ++i) {
          const angle = (Math.PI * i) / kAround;
          const at = new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), (-length * ring) / 10).applyMatrix4(frames[segment]!);
          made.position.push(at.x, at.y, at.z);
          made.owner.push(segment);
          if (ring === 0 || i === 0) continue;
          const d = first + ring * (kAround + 1) + i;
          const [a, b, c] = [d - kAround - 2, d - kAround - 1, d - 1];
          made.index.push(a, c, d, a, d, b);
        }
      }
    }
    return made;
  }

  it("are one on each digit's tip, on its back, a little above the skin in the middle and below it at the border", () => {
    const skin = fingertips();
    const hand = boundHand(skin.frames, skin.position, skin.owner);
    const nails = nailsOn(hand, skin, skin.owner);
    expect([...new Set(nails.segment)]).toEqual(tips);
    expect(tips.every(isTip)).toBe(true);
    const point = new Vector3();
    const normal = new Vector3();
    nails.segment.forEach((segment, i) => {
      point.fromArray(nails.position, 3 * i).applyMatrix4(hand.inverses[segment]!);
      normal.fromArray(nails.normal, 3 * i).transformDirection(hand.inverses[segment]!);
      const [row, across] = [nails.detail[4 * i]!, nails.detail[4 * i + 1]!];
      const border = row === 0 || row === 1 || Math.abs(across) === 1;
      const above = point.y - Math.sqrt(radius * radius - point.x * point.x);
      if (border) expect(above).toBeLessThan(-0.2e-3);
      else expect(above).toBeGreaterThan(0.1e-3);
      expect(Math.abs(above)).toBeLessThan(1.2e-3);
      expect(normal.y).toBeGreaterThan(0.5);
      expect(-point.z).toBeGreaterThan(0.4 * length);
      expect(-point.z).toBeLessThan(length);
    });
  });
  it("have triangles that are seen from outside", () => {
    const skin = fingertips();
    const hand = boundHand(skin.frames, skin.position, skin.owner);
    const nails = nailsOn(hand, skin, skin.owner);
    const corner = (k: number) => new Vector3().fromArray(nails.position, 3 * nails.index[k]!);
    for (let i = 0; i < nails.index.length; i += 3) {
      const across = corner(i + 1).sub(corner(i)).cross(corner(i + 2).sub(corner(i)));
      expect(across.dot(new Vector3().fromArray(nails.normal, 3 * nails.index[i]!))).toBeGreaterThan(0);
    }
  });
  it("are left out where there is no skin to lie on", () => {
    const skin = fingertips();
    const hand = boundHand(skin.frames, skin.position, skin.owner);
    expect(nailsOn(hand, { position: skin.position, index: skin.index.slice(0, 30) }, skin.owner).segment).toEqual([]);
  });
});

describe("the palm's lines", () => {
  it("go through the palm, between its knuckles and the wrist, of either hand", () => {
    for (const side of [1, -1]) {
      const inverses = Array.from({ length: kSegments }, () => new Matrix4());
      [1, 2, 3, 4].forEach((digit, i) => (inverses[3 * digit] = new Matrix4().makeTranslation(-side * (0.02 * i - 0.03), 0, 0.09)));
      const lines = palmLines(inverses);
      expect(lines.length).toBe(3);
      for (const { circle, reach } of lines) {
        const begin = [reach.x, reach.y] as const;
        const square = reach.z * reach.z + reach.w * reach.w;
        const end = [reach.x + reach.z / square, reach.y + reach.w / square] as const;
        for (const [x, z] of [begin, end]) {
          expect(Math.hypot(x - circle.x, z - circle.y)).toBeCloseTo(circle.z, 6);
          expect(Math.abs(x)).toBeLessThan(0.05);
          expect(z).toBeGreaterThan(-0.09);
          expect(z).toBeLessThan(0.01);
        }
      }
    }
  });
});
