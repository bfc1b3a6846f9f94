// SPDX-License-Identifier: Apache-2.0
// The keys of the page. Space and Esc mean Stop and nothing else.
import type { CameraPreset } from "../view3d/hand_view";
import { isTextField, listenToStopKeys } from "./stop_keys";
import { kZoomStep } from "./view_frame";

export interface KeyActions {
  stop(): void;
  pause(): void;
  help(): void;
  camera(preset: CameraPreset): void;
  zoom(factor: number): void;
}

/// Views of the camera by key.
export const presets: Readonly<Record<string, CameraPreset>> = { "1": "home", "2": "palm", "3": "thumb", "4": "contact" };

/// @param source  the window: listens before anything on the page does
export function listenToKeys(source: Window, actions: KeyActions): void {
  listenToStopKeys(source, () => actions.stop(), (event) => {
    if (isTextField(event.target) || event.ctrlKey || event.altKey || event.metaKey) return;
    const preset = presets[event.key];
    if (preset) actions.camera(preset);
    else if (event.key === "+" || event.key === "=") actions.zoom(kZoomStep);
    else if (event.key === "-") actions.zoom(1 / kZoomStep);
    else if (event.key === "p" || event.key === "P") actions.pause();
    else if (event.key === "?") actions.help();
    else return;
    event.preventDefault();
  });
}
