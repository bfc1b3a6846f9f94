// SPDX-License-Identifier: Apache-2.0
// When a person has let go of a slider: a change may be missing where a finger leaves the screen or the slider is taken away.

/// Calls `end` whenever no person can be dragging the slider any more; also several times for one drag. A key that is held down drags too:
/// the browser says "change" for each of its repetitions.
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
