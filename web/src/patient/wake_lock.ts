// SPDX-License-Identifier: Apache-2.0
// Keeps the display on while the page is seen. A browser has a wake lock over https or on the same computer only; docs/patient-screen.md says
// what is to be done without one.

/// The part of a navigator that is used here.
export interface Awake {
  readonly wakeLock?: { request(type: "screen"): Promise<unknown> };
}

/// Asks for the lock now, and again each time the page is seen again: a browser ends it with a page that is hidden. Failures are ignored.
/// @returns ends the asking
export function keepAwake(browser: Awake = navigator as Awake, page: Document = document): () => void {
  const ask = () => {
    if (page.visibilityState !== "visible") return;
    try {
      void browser.wakeLock?.request("screen").catch(() => undefined);
    } catch {
      // a browser that forbids it at once: the display follows the computer's own settings
    }
  };
  ask();
  page.addEventListener("visibilitychange", ask);
  return () => page.removeEventListener("visibilitychange", ask);
}
