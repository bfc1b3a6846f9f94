// SPDX-License-Identifier: Apache-2.0
// A screen with fewer frames a second: what the processor draws with costs less, and the page goes through the same steps.

/// Runs in the page, before anything of its own.
export function slowScreen(hertz: number): void {
  const own = window.requestAnimationFrame.bind(window);
  let waiting = new Map<number, FrameRequestCallback>();
  let [last, number, asked] = [-Infinity, 0, false];
  const frame = (at: number): void => {
    const due = waiting;
    waiting = new Map();
    asked = false;
    last = performance.now();
    for (const call of due.values()) call(at);
  };
  window.requestAnimationFrame = (call) => {
    waiting.set(++number, call);
    if (!asked) setTimeout(() => own(frame), Math.max(0, last + 1000 / hertz - performance.now()));
    asked = true;
    return number;
  };
  window.cancelAnimationFrame = (which) => void waiting.delete(which);
}
