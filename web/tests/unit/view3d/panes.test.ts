// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { panesFor, viewsWithRoom } from "../../../src/view3d/panes";

it("views side by side fill the width, each another preset than the first", () => {
  for (const main of ["home", "palm", "thumb", "contact", null] as const) {
    for (const count of [1, 2, 3]) {
      const panes = panesFor(count, main);
      expect(panes.length).toBe(count);
      expect(panes[0]!.preset).toBe(main);
      expect(new Set(panes.map(({ preset }) => preset)).size).toBe(count);
      panes.forEach((pane, i) => expect(pane.left).toBeCloseTo(panes.slice(0, i).reduce((sum, { width }) => sum + width, 0), 9));
      expect(panes.reduce((sum, { width }) => sum + width, 0)).toBeCloseTo(1, 9);
    }
  }
  expect(panesFor(3, "home").map(({ preset }) => preset)).toEqual(["home", "palm", "contact"]);
});

it("there are no more views than have room", () => {
  expect([300, 559, 560, 899, 900, 1900].map((width) => viewsWithRoom(3, width))).toEqual([1, 1, 2, 2, 3, 3]);
  expect([0, 1, 2, 3, 9].map((wished) => viewsWithRoom(wished, 1900))).toEqual([1, 1, 2, 3, 3]);
});
