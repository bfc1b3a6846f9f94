// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { clockTime } from "../../../src/panels/as_text";

it("the clock says hours from 0 to 23, minutes and seconds", () => {
  const at = (hours: number, minutes: number, seconds: number) => clockTime(new Date(2026, 10, 22, hours, minutes, seconds).getTime() / 1000);
  expect(at(14, 3, 59)).toBe("14:03:59");
  expect(at(0, 0, 7)).toBe("00:00:07");
  expect(clockTime(new Date(2026, 10, 22, 14, 3, 59, 250).getTime() / 1000, 2)).toBe("14:03:59.25");
});
