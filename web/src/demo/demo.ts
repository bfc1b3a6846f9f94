// SPDX-License-Identifier: Apache-2.0
// The start of demo.html: one file that holds the program and a recording, and opens from disk. It asks no server for anything.
import { helpDialog } from "../panels/dialog";
import { button, el } from "../panels/dom";
import { Look, lookSwitches } from "../panels/look";
import { openRecording } from "../replay/recording";
import { listenToReplayKeys } from "../replay/replay_keys";
import { replayView } from "../replay/replay_view";
import { strings } from "../strings";
import type { ViewProbe } from "../view3d/hand_view";
import { inThisThread } from "./in_this_thread";
import { embeddedSource } from "./embedded_source";

declare global {
  interface Window {
    /// The demo's state, for tests and for the script that makes the animation.
    phalanxDemo: {
      ready: () => boolean; // the first hand is drawn
      length: () => number; // [s]
      position: () => number;
      seek: (time: number) => void;
      settled: () => boolean; // the hand of the chosen moment is drawn
      view: () => ViewProbe | undefined;
    };
  }
}

const words = strings.replay;

/// Replaces the page's first words. @throws what is wrong with the recording or this browser
async function start(): Promise<void> {
  const recording = await openRecording(await embeddedSource());
  const page = document.getElementById("page")!;
  const dialogs = el("div", { class: "dialogs", hidden: true });
  document.documentElement.dataset["open"] = "true";
  const help = () => helpDialog({ dialogs }, words.keys.title, words.keys.rows, words.keys.note);
  let setTheme = (_theme: "dark" | "light") => {};
  const look = new Look((theme) => setTheme(theme));
  const view = replayView(recording, look.theme, inThisThread);
  setTheme = (theme) => view.setTheme(theme);
  const header = el(
    "header",
    { class: "header demo-head" },
    el("h1", {}, "Phalanx"),
    el("p", {}, "Demo: a recorded grasp, simulated"),
    el("div", { class: "header-tools" }, ...lookSwitches(look).elements, button("?", help, { "aria-label": strings.look.help, title: strings.look.help })),
  );
  const what = document.getElementById("what")!;
  page.replaceChildren(header, el("div", { class: "content" }, view.content[0]!, what), view.dock, dialogs);

  const player = view.player;
  listenToReplayKeys(window, {
    isOpen: () => true,
    escape: () => dialogs.querySelector(".dialog")?.dispatchEvent(new Event("phalanx-close")),
    toggle: () => view.toggle(),
    skip: (seconds) => view.skip(seconds),
    pose: (direction) => void player.step(direction),
    event: (direction) => view.event(direction),
    goTo: (end) => player.seek(end === "begin" ? 0 : recording.seconds),
    faster: (steps) => player.playhead.faster(steps),
    help,
    camera: (preset) => view.frame.camera(preset),
    zoom: (factor) => view.frame.zoom(factor),
  });
  const probe = () => view.frame.view()?.probe();
  window.phalanxDemo = {
    ready: () => (probe()?.frames ?? 0) > 0 && player.tick !== undefined,
    length: () => recording.seconds,
    position: () => player.playhead.position,
    seek: (time) => {
      player.playhead.pause();
      player.seek(time);
    },
    settled: () => !player.loading && player.tick !== undefined && probe()?.tick === player.tick.tick,
    view: probe,
  };
  void player.seekFirst();
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) player.playhead.play();
  const onFrame = (now: number): void => {
    requestAnimationFrame(onFrame); // first: whatever goes wrong below, the page goes on
    view.draw(now);
  };
  requestAnimationFrame(onFrame);
}

start().catch((reason: unknown) => {
  console.error(reason);
  document.getElementById("opening")!.textContent = `The recording cannot be shown: ${String(reason)}`;
});
