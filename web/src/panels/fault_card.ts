// SPDX-License-Identifier: Apache-2.0
// A fault, over the view: what it means, what to do, its report, and Reset.
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import { button, el, setShown, setText } from "./dom";

const words = strings.fault;

/// Shown while there is a fault.
export function faultCard(app: App): HTMLElement {
  const name = el("h2", { class: "fault-name" });
  const meaning = el("p");
  const remedy = el("p");
  const facts = el("p", { class: "hint" });
  const report = el("a", { href: "report" }, words.report);
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const pressed = el("p", { class: "warning", hidden: true }, words.pressed);
  const reset = button(words.reset, () => void go(), { class: "primary" });
  async function go(): Promise<void> {
    setText(error, refusal(await app.host.reset(app.store.state?.fault?.time ?? 0)));
    setShown(error, error.textContent !== "");
  }
  const element = el("section", { class: "fault-card fault", role: "alert" }, name, meaning, remedy, facts, pressed, error, el("div", { class: "buttons" }, reset, report));
  const update = () => {
    const { state, welcome, role } = app.store;
    const fault = app.store.connected ? state?.fault : undefined;
    setShown(element, fault !== undefined);
    if (!fault) {
      setShown(error, false);
      return;
    }
    setText(name, words.title(fault.name.replaceAll("_", " ")));
    setText(meaning, fault.meaning);
    setText(remedy, words.remedy(fault.remedy));
    const parts = [fault.fromDevice ? words.fromDevice : "", fault.channel >= 0 ? words.channel(fault.channel) : "", fault.report === "" ? words.reportPending : ""];
    setText(facts, parts.filter((text) => text !== "").join(" · "));
    setShown(facts, facts.textContent !== "");
    setShown(report, fault.report !== "" && welcome?.mayOperate === true);
    report.download = words.reportFile(fault.name);
    setShown(pressed, state?.estop === true);
    reset.disabled = !mayChange(role) || state?.estop === true;
    reset.title = state?.estop ? words.pressed : mayChange(role) ? "" : words.resetViewer;
  };
  app.store.on(["state", "connection"], update);
  update();
  return element;
}
