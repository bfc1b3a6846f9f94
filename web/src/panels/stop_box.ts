// SPDX-License-Identifier: Apache-2.0
// Stop, what state the station is in, and the way back. Always in sight, never covered.
import { SafetyState } from "../gen/phalanx/tick_pb";
import type { Store } from "../state/store";
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import { StopOrder, type StopProgress } from "../wire/stop_order";
import { refusal, type App } from "./app";
import { clockTime } from "./as_text";
import { button, el, setAttribute, setShown, setText } from "./dom";
import { onPress } from "./press";

export type SafetyName = keyof typeof strings.safety;

const names: Readonly<Record<SafetyState, SafetyName>> = {
  [SafetyState.SAFETY_WAITING]: "waiting",
  [SafetyState.SAFETY_STARTING]: "starting",
  [SafetyState.SAFETY_RUNNING]: "running",
  [SafetyState.SAFETY_STOPPING]: "stopping",
  [SafetyState.SAFETY_STOPPED]: "stopped",
  [SafetyState.SAFETY_FAULT]: "fault",
};

/// The station's state, as far as the page knows it.
export function safetyName(store: Store): SafetyName {
  const state = store.known;
  if (!state) return "unknown";
  if (state.wizard) return "calibrating";
  if (state.stationGone) return "gone";
  return names[state.safety] ?? "unknown";
}

export interface StopBox {
  readonly element: HTMLElement;
  stop(): void;
  update(): void; // silence has to be seen, too
}

export function stopBox(app: App): StopBox {
  const { store } = app;
  let confirmedAt = ""; // time of day
  let trouble = ""; // why Resume was refused
  let connected = false;

  const name = el("strong", { class: "state-name" });
  const meaning = el("span", { class: "state-meaning" });
  const resume = button(strings.stop.resume, () => void goOn(), { class: "resume primary" });
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const said = el("p", { class: "stop-said", role: "status", "aria-live": "assertive" });
  const note = el("p", { class: "stop-note", id: "stop-note" });
  const press = el(
    "button",
    { type: "button", class: "stop", "aria-describedby": "stop-note" },
    el("span", { class: "stop-word" }, strings.stop.button),
    el("span", { class: "stop-soft" }, `(${strings.stop.soft})`),
  );
  const order = new StopOrder(
    (atOnce) => (atOnce ? app.host.stop(0) : app.host.stop()),
    () => {
      if (order.progress === "confirmed") confirmedAt = clockTime(Date.now() / 1000);
      update();
    },
  );
  onPress(press, stop);

  function stop(): void {
    trouble = "";
    order.press(store.known);
    update();
  }

  async function goOn(): Promise<void> {
    trouble = refusal(await app.host.resume(store.state?.stops ?? 0n));
    update();
  }

  /// The progress of the stop, unless the line above states it.
  function words(progress: StopProgress, known: boolean): string {
    switch (progress) {
      case "none":
        return "";
      case "sent":
        return store.connected ? strings.stop.sent : strings.stop.sentOffline;
      case "owed":
        return strings.stop.failed;
      case "confirmed":
        return known ? "" : strings.stop.confirmed(confirmedAt);
    }
  }

  function update(): void {
    const known = store.known;
    const state = safetyName(store);
    const held = known?.heldStopped ?? false;
    if (known && !held) trouble = "";
    setAttribute(element, "data-state", state);
    setText(name, strings.safety[state]);
    setText(meaning, store.connected && !known ? strings.stop.silent : strings.safetyMeaning[state]);
    setShown(resume, held && !known?.wizard); // a calibration rests the station until it ends
    resume.disabled = !mayChange(store.role);
    resume.title = mayChange(store.role) ? strings.stop.resumeHint : strings.stop.resumeViewer;
    setText(refused, trouble);
    setShown(refused, trouble !== "");
    const text = words(order.progress, known !== undefined);
    setText(said, text);
    setShown(said, text !== "");
    setAttribute(said, "data-bad", String(order.progress === "owed" || !known));
    setText(note, store.connected ? strings.stop.note : strings.stop.noteOffline);
  }

  const element = el(
    "section",
    { class: "stop-box", "aria-label": strings.stop.region },
    el("div", { class: "state-line", role: "status" }, el("div", { class: "state-words" }, name, meaning), resume),
    refused,
    said,
    press,
    note,
  );
  store.on(["connection"], () => {
    if (store.connected && !connected) order.welcomed();
    connected = store.connected;
  });
  store.on(["state"], () => order.heard(store.known));
  store.on(["state", "connection", "own"], update);
  update();
  return { element, stop, update };
}
