// SPDX-License-Identifier: Apache-2.0
// The recording that the station writes: whether it goes on, as a word in the top line, and the way to the page of recordings.
import type { Recording } from "../gen/phalanx/cockpit_pb";
import { strings } from "../strings";
import type { App } from "./app";
import { el, setShown, setText } from "./dom";

/// Age of a step that is still not on the disk, of which people are told [s]; as in `phalanx run`.
const LONG_UNSAVED = 0.7;

/// Whether steps are at risk: the disk refuses them, or is slow.
export function isBehind(recording: Recording): boolean {
  return recording.trouble !== "" || recording.unsaved > LONG_UNSAVED;
}

export function recordingChip(app: App): HTMLElement {
  const chip = el("span", { class: "chip" });
  const update = () => {
    const { state, connected } = app.store;
    const recording = state?.recording;
    const behind = recording !== undefined && isBehind(recording);
    setText(chip, !recording ? strings.recording.off : behind ? strings.recording.behind : strings.recording.on);
    chip.title = recording?.file ?? "";
    chip.classList.toggle("chip-recording", recording !== undefined && !behind);
    chip.classList.toggle("chip-bad", behind);
    setShown(chip, state !== undefined && connected);
  };
  app.store.on(["state", "connection"], update);
  update();
  return chip;
}

/// Opens recordings in a tab of their own: this page goes on, and is a tab away.
export function recordingsLink(): HTMLElement {
  return el("p", {}, el("a", { href: "recording.html", target: "_blank", rel: "noopener" }, strings.replay.link), el("small", { class: "link-hint" }, strings.replay.linkHint));
}
