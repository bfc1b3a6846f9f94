// SPDX-License-Identifier: Apache-2.0
// Why there is no station, and the way back.
import type { State } from "../gen/phalanx/cockpit_pb";
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import { button, el, setShown, setText } from "./dom";
import { plainWords } from "./plain_words";

const words = strings.gone;
const kNoFault = 0; // Reset.fault_time

/// Nothing runs, and nothing is on its way that would change that.
export function isStuck(state: State | undefined): boolean {
  return state !== undefined && state.stationGone && state.busy === "" && state.wizard === undefined;
}

export function troubleCard(app: App): HTMLElement {
  const why = el("p", { class: "trouble-why" });
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const again = button(words.again, () => void go(), { class: "primary" });
  const hint = el("p", { class: "hint" }, words.viewer);
  async function go(): Promise<void> {
    again.disabled = true;
    setText(error, refusal(await app.host.reset(kNoFault)));
    setShown(error, error.textContent !== "");
    update();
  }
  const element = el("section", { class: "fault-card trouble-card", role: "alert" }, el("h2", {}, words.title), why, error, el("div", { class: "buttons" }, again), hint);
  const update = () => {
    const stuck = app.store.connected && isStuck(app.store.state);
    setShown(element, stuck);
    if (!stuck) return setShown(error, false);
    setText(why, plainWords(app.store.state?.trouble ?? "") || words.noReason);
    again.disabled = !mayChange(app.store.role);
    setShown(hint, again.disabled);
  };
  app.store.on(["state", "connection"], update);
  update();
  return element;
}
