// SPDX-License-Identifier: Apache-2.0
// The end of a drag. The browser's event `change` may be missing if a finger leaves the screen or the slider is removed.

/// Calls `end` when the slider can no longer be dragged; also several times for one drag. A key that is held down is a drag, too: the browser
/// sends `change` for each repetition.
export function onLetGo(slider: HTMLInputElement, end: () => void): void {
  let key = false; // held down
  slider.addEventListener("keydown", () => (key = true));
  slider.addEventListener("change", () => !key && end());
  for (const event of ["keyup", "pointerup", "pointercancel", "blur"]) {
    slider.addEventListener(event, () => {
      key = false;
      end();
    });
  }
}
