// SPDX-License-Identifier: Apache-2.0
import { afterEach, expect, it, vi } from "vitest";
import { lasting, session } from "../../../src/wire/memory";

afterEach(() => vi.unstubAllGlobals());

it("says whether what was written is kept, so that nobody builds on it in a browser that forbids or forgets", () => {
  expect(session.set("a", "1")).toBe(true);
  expect(session.get("a")).toBe("1");
  vi.stubGlobal("sessionStorage", { setItem: () => {}, getItem: () => null });
  expect(session.set("a", "2")).toBe(false);
  expect(session.get("a")).toBe("");
  const forbidden = () => {
    throw new Error("SecurityError");
  };
  vi.stubGlobal("localStorage", { setItem: forbidden, getItem: forbidden });
  expect(lasting.set("a", "2")).toBe(false);
  expect(lasting.get("a")).toBe("");
});
