// SPDX-License-Identifier: Apache-2.0
// The keys of a recording's page. Space plays and pauses; buttons are pressed with Enter, as in the cockpit.
import { presets } from "../panels/keyboard";
import { isTextField } from "../panels/stop_keys";
import { kZoomStep } from "../panels/view_frame";
import type { CameraPreset } from "../view3d/hand_view";

export interface ReplayActions {
  isOpen(): boolean; // a recording is open
  escape(): void;
  toggle(): void;
  skip(seconds: number): void;
  pose(direction: 1 | -1): void;
  event(direction: 1 | -1): void;
  goTo(end: "begin" | "end"): void;
  faster(steps: number): void;
  help(): void;
  camera(preset: CameraPreset): void;
  zoom(factor: number): void;
}

function action(key: string, shift: boolean, actions: ReplayActions): (() => void) | undefined {
  const preset = presets[key];
  if (preset) return () => actions.camera(preset);
  switch (key) {
    case "ArrowLeft":
      return () => (shift ? actions.pose(-1) : actions.skip(-1));
    case "ArrowRight":
      return () => (shift ? actions.pose(1) : actions.skip(1));
    case ",":
      return () => actions.pose(-1);
    case ".":
      return () => actions.pose(1);
    case "PageUp":
      return () => actions.event(-1);
    case "PageDown":
      return () => actions.event(1);
    case "Home":
      return () => actions.goTo("begin");
    case "End":
      return () => actions.goTo("end");
    case "<":
      return () => actions.faster(-1);
    case ">":
      return () => actions.faster(1);
    case "+":
    case "=":
      return () => actions.zoom(kZoomStep);
    case "-":
      return () => actions.zoom(1 / kZoomStep);
    default:
      return undefined;
  }
}

export function listenToReplayKeys(source: Window, actions: ReplayActions): void {
  /// Dialogs, and the page on which a recording is chosen, keep their keys.
  const isForRecording = ({ target }: KeyboardEvent) =>
    actions.isOpen() && !isTextField(target) && !(target instanceof Element && target.closest("[role=dialog]"));
  const isPlay = (event: KeyboardEvent) => event.key === " " && isForRecording(event);
  const swallow = (event: Event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  source.addEventListener(
    "keydown",
    (event) => {
      if (!isPlay(event)) return;
      swallow(event);
      if (!event.repeat) actions.toggle();
    },
    { capture: true },
  );
  source.addEventListener("keyup", (event) => isPlay(event) && swallow(event), { capture: true }); // some browsers press a button then
  // What has the focus takes its keys first: the view turns, a plot reads its values.
  source.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || isTextField(event.target) || event.ctrlKey || event.altKey || event.metaKey) return;
    const always = { Escape: actions.escape, "?": actions.help }[event.key];
    const act = always ?? (isForRecording(event) ? action(event.key, event.shiftKey, actions) : undefined);
    if (!act) return;
    act();
    event.preventDefault();
  });
}
