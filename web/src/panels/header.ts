// SPDX-License-Identifier: Apache-2.0
// The top line: what is shown, what moves it, who has control, and how the page looks.
import { strings } from "../strings";
import type { App } from "./app";
import { button, el, setShown, setText } from "./dom";
import { helpDialog } from "./dialog";
import { unreviewedMark } from "./language_choice";
import { lookSwitches, type Look } from "./look";
import { recordingChip } from "./recording";
import { operatorName } from "./role_strip";
import { sceneName } from "./scene_cards";

/// Lists the keys of the cockpit.
export function keysDialog(app: App): void {
  helpDialog(app, strings.help.title, strings.help.rows, strings.help.note);
}

export function header(app: App, look: Look): HTMLElement {
  const scene = el("span", { class: "header-scene" });
  const source = el("span", { class: "chip" });
  const who = el("span", { class: "chip" });
  const switches = lookSwitches(look);
  const update = () => {
    const { state, role, connected } = app.store;
    setText(scene, state ? sceneName(state.scene) : "");
    scene.title = state?.sceneDescription ?? "";
    setText(source, state && connected ? (strings.hand.sources[state.source] ?? "") : strings.dash);
    setShown(source, state !== undefined);
    setText(who, strings.people.inControl(connected ? (role === "mine" ? strings.me : operatorName(app)) : strings.dash));
    setShown(who, state !== undefined);
    switches.update();
  };
  app.store.on(["state", "connection"], update);
  update();
  return el(
    "header",
    { class: "header" },
    el("h1", {}, strings.product),
    scene,
    source,
    who,
    recordingChip(app),
    unreviewedMark(),
    el("div", { class: "header-tools" }, ...switches.elements, button("?", () => keysDialog(app), { "aria-label": strings.look.help, title: strings.look.help })),
  );
}
