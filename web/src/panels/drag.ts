// SPDX-License-Identifier: Apache-2.0
// When a person has let go of a slider: a change may be missing where a finger leaves the screen or the slider is taken away.

/// Calls `end` whenever no person can be dragging the slider any more; also several times for one drag.
export function onLetGo(slider: HTMLInputElement, end: () => void): void {
  for (const event of ["change", "pointerup", "pointercancel", "blur"]) slider.addEventListener(event, end);
}
