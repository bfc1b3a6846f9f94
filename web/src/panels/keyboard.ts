// SPDX-License-Identifier: Apache-2.0
// The keys of the page. Space and Esc mean Stop and nothing else.
import type { CameraPreset } from "../view3d/hand_view";
import { kZoomStep } from "./view_frame";

export interface KeyActions {
  stop(): void;
  pause(): void;
  help(): void;
  camera(preset: CameraPreset): void;
  zoom(factor: number): void;
}

/// Least interval at which a key that is held down repeats Stop [ms].
const kStopAgainMs = 200;
/// Views of the camera by key.
export const presets: Readonly<Record<string, CameraPreset>> = { "1": "home", "2": "palm", "3": "thumb", "4": "contact" };
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

/// @param source  the window: listens before anything on the page does
export function listenToKeys(source: Window, actions: KeyActions): void {
  const swallow = (event: Event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  let stopped = -Infinity; // time of the last stop by a key [ms]
  // While a text is being composed the key has no name, only its place.
  const isStop = (event: KeyboardEvent) =>
    event.key === "Escape" || event.code === "Escape" || (event.key === " " && !takesBlanks(event.target));

  source.addEventListener(
    "keydown",
    (event) => {
      if (isStop(event)) {
        if (event.key === " ") swallow(event);
        if (event.repeat && performance.now() - stopped < kStopAgainMs) return;
        stopped = performance.now();
        actions.stop();
        return;
      }
      if (isTextField(event.target) || event.ctrlKey || event.altKey || event.metaKey) return;
      const preset = presets[event.key];
      if (preset) actions.camera(preset);
      else if (event.key === "+" || event.key === "=") actions.zoom(kZoomStep);
      else if (event.key === "-") actions.zoom(1 / kZoomStep);
      else if (event.key === "p" || event.key === "P") actions.pause();
      else if (event.key === "?") actions.help();
      else return;
      event.preventDefault();
    },
    { capture: true },
  );
  // Some browsers press a button when Space comes up.
  source.addEventListener("keyup", (event) => event.key === " " && isStop(event) && swallow(event), { capture: true });
}
