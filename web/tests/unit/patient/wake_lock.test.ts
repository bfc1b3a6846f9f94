// SPDX-License-Identifier: Apache-2.0
import { expect, it, vi } from "vitest";
import { keepAwake } from "../../../src/patient/wake_lock";

it("asks for the display to stay on, and again when the page is seen again", () => {
  const request = vi.fn(() => Promise.resolve());
  const end = keepAwake({ wakeLock: { request } });
  expect(request.mock.calls).toEqual([["screen"]]);
  document.dispatchEvent(new Event("visibilitychange"));
  expect(request).toHaveBeenCalledTimes(2);
  const hidden = vi.spyOn(document, "visibilityState", "get").mockReturnValue("hidden");
  document.dispatchEvent(new Event("visibilitychange"));
  expect(request, "not while it is hidden").toHaveBeenCalledTimes(2);
  end();
  hidden.mockRestore();
  document.dispatchEvent(new Event("visibilitychange"));
  expect(request).toHaveBeenCalledTimes(2);
});

it("goes on where the browser has no lock or refuses it", async () => {
  keepAwake({})();
  keepAwake({ wakeLock: { request: () => Promise.reject(new Error("battery")) } })();
  keepAwake({ wakeLock: { request: () => { throw new Error("forbidden"); } } })();
  await Promise.resolve();
});
