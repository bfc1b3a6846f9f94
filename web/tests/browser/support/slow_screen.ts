// SPDX-License-Identifier: Apache-2.0
// What makes a page cheaper that the processor draws, while it goes through the same steps. Both run in the page, before anything of its own.

/// A screen with fewer frames a second.
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

/// The calls that paint triangles do nothing.
export function paintNothing(): void {
  for (const name of ["drawArrays", "drawArraysInstanced", "drawElements", "drawElementsInstanced", "drawRangeElements"] as const) {
    WebGL2RenderingContext.prototype[name] = () => undefined;
  }
}
