// SPDX-License-Identifier: Apache-2.0
// The papers' result as a quiet line of four steps above the view. It is there for simulated devices only: it makes a hand shake.
import { HandSource } from "../gen/phalanx/cockpit_pb";
import { number } from "../state/toml";
import { kStoryStiffness, Story } from "../state/story";
import { strings } from "../strings";
import { session } from "../wire/memory";
import type { App } from "./app";
import { button, el, setAttribute, setShown } from "./dom";
import { smoothingIsOn, stabiliserInForce } from "./smoothing";

const kHidden = "phalanx.story";
const words = strings.story;

export function storyRibbon(app: App): HTMLElement {
  const story = new Story();
  let told = false; // it has begun in this scene
  let scene = "";
  const steps = words.steps.map((text) => el("li", {}, el("span", { class: "story-mark", "aria-hidden": "true" }), el("span", {}, text), el("span", { class: "visually-hidden" })));
  steps[0]!.title = words.stiffer(String(kStoryStiffness));
  const hide = button("×", () => {
    session.set(kHidden, "hidden");
    update();
  }, { class: "quiet", "aria-label": words.hide, title: words.hide });
  const element = el("section", { class: "story", "aria-label": words.title, hidden: true }, el("ol", {}, ...steps), hide);

  function update(): void {
    const { state, light } = app.store;
    const simulated = state !== undefined && state.deviceSimulated && state.source === HandSource.HAND_PATIENT;
    if (state && state.scene !== scene) {
      scene = state.scene;
      told = false;
      story.restart();
    }
    told ||= simulated && stabiliserInForce(app) === "none";
    const shown = told && simulated && session.get(kHidden) === "";
    setShown(element, shown);
    if (!shown) return;
    const input = { stiffness: number(app.store.value("force.stiffness_n_per_mm")), smoothing: smoothingIsOn(app), verdict: light.shown.kind, now: performance.now() / 1000 };
    const done = story.feed(input);
    steps.forEach((step, i) => {
      const is = i < done ? "done" : i === done ? "next" : "later";
      if (step.dataset["is"] === is) return;
      step.dataset["is"] = is;
      setAttribute(step, "aria-current", is === "next" ? "step" : null);
      step.lastElementChild!.textContent = is === "later" ? "" : ` (${words[is]})`;
    });
  }
  app.store.on(["state", "tick", "own", "connection"], update);
  update();
  return element;
}
