// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { ContactFocus } from "../../../src/view3d/contact_focus";
import type { Mark } from "../../../src/view3d/contact_marks";

const mark = (segment: number, force: number, touching = true): Mark => ({
  segment, force, touching, slips: false, point: [segment, 0, 0], normal: [0, 0, 1],
});

/// Segments that it follows over so many steps of 50 ms.
function followed(focus: ContactFocus, marks: readonly Mark[], steps: number): (number | undefined)[] {
  return Array.from({ length: steps }, () => focus.update(marks, 0.05)?.[0]);
}

describe("the followed contact", () => {
  it("is the strongest one, at once where there was none", () => {
    expect(followed(new ContactFocus(), [mark(2, 1), mark(5, 3)], 1)).toEqual([5]);
    expect(followed(new ContactFocus(), [mark(2, 1, false)], 20).every((one) => one === undefined)).toBe(true);
  });
  it("does not jump between two that are about as strong, whichever is stronger at the moment", () => {
    const focus = new ContactFocus();
    followed(focus, [mark(2, 1)], 1);
    for (let i = 0; i < 100; ++i) expect(focus.update([mark(2, 1), mark(5, i % 2 === 0 ? 1.2 : 0.9)], 0.05)![0]).toBe(2);
    // Nor to one that is much stronger now and then.
    for (let i = 0; i < 100; ++i) expect(focus.update([mark(2, 1), mark(5, i % 4 === 0 ? 1 : 5)], 0.05)![0]).toBe(2);
  });
  it("goes over to one that is clearly stronger for a while", () => {
    const focus = new ContactFocus();
    followed(focus, [mark(2, 1)], 1);
    const after = followed(focus, [mark(2, 1), mark(5, 2)], 20);
    expect(after[5]).toBe(2);
    expect(after.at(-1)).toBe(5);
    expect(after.filter((one, i) => i > 0 && one !== after[i - 1]).length).toBe(1);
  });
  it("stays for a moment where a contact ends, and then is none", () => {
    const focus = new ContactFocus();
    followed(focus, [mark(2, 1)], 1);
    const after = followed(focus, [], 40);
    expect(after[3]).toBe(2);
    expect(after.at(-1)).toBeUndefined();
  });
  it("is forgotten with the object", () => {
    const focus = new ContactFocus();
    followed(focus, [mark(2, 5)], 1);
    focus.forget();
    expect(followed(focus, [mark(8, 1)], 1)).toEqual([8]);
  });
});
