// SPDX-License-Identifier: Apache-2.0
// The keys that stop: Esc everywhere, Space except where words are typed. They mean nothing else on a page that has STOP.

/// Least interval at which a key that is held down repeats Stop [ms].
const kStopAgainMs = 200;
const typed = new Set(["text", "search", "number", "email", "url", "tel", "password"]);

/// Whether letters and figures go into it.
export function isTextField(target: EventTarget | null): boolean {
  if (target instanceof HTMLTextAreaElement) return true;
  if (target instanceof HTMLInputElement) return typed.has(target.type);
  return target instanceof HTMLElement && target.isContentEditable;
}

/// Whether a blank means anything in it: in a number it does not.
function takesBlanks(target: EventTarget | null): boolean {
  const number = target instanceof HTMLInputElement && (target.type === "number" || target.getAttribute("inputmode") === "decimal");
  return isTextField(target) && !number;
}

/// While a text is being composed the key has no name, only its place.
function isStop(event: KeyboardEvent): boolean {
  return event.key === "Escape" || event.code === "Escape" || (event.key === " " && !takesBlanks(event.target));
}

function swallow(event: Event): void {
  event.preventDefault();
  event.stopImmediatePropagation();
}

/// @param source  the window: listens before anything on the page does
/// @param other   gets each key that does not stop
export function listenToStopKeys(source: Window, stop: () => void, other: (event: KeyboardEvent) => void = () => {}): void {
  let stopped = -Infinity; // time of the last stop by a key [ms]
  source.addEventListener(
    "keydown",
    (event) => {
      if (!isStop(event)) return other(event);
      if (event.key === " ") swallow(event);
      if (event.repeat && performance.now() - stopped < kStopAgainMs) return;
      stopped = performance.now();
      stop();
    },
    { capture: true },
  );
  // Some browsers press a button when Space comes up.
  source.addEventListener("keyup", (event) => event.key === " " && isStop(event) && swallow(event), { capture: true });
}
