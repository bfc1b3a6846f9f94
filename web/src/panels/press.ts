// SPDX-License-Identifier: Apache-2.0
// A button that acts when it goes down, not when it comes up.

/// The click that belongs to a press comes at most so long after the finger has left [ms].
const kClickMs = 400;
const kPrimary = 0;

/// Acts once a press, when the finger or the primary mouse button goes down. Acts also on clicks without a pointer: Enter, assistive technology.
export function onPress(button: HTMLElement, act: () => void): void {
  let pressed = false; // its click is still to come
  let over: ReturnType<typeof setTimeout> | undefined;
  const release = () => {
    clearTimeout(over);
    over = setTimeout(() => (pressed = false), kClickMs);
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== kPrimary) return;
    clearTimeout(over);
    pressed = true;
    act();
    window.addEventListener("pointerup", release, { capture: true, once: true });
    window.addEventListener("pointercancel", release, { capture: true, once: true });
  });
  button.addEventListener("click", (event) => {
    const done = pressed && event.detail !== 0;
    pressed = false;
    if (!done) act();
  });
}
