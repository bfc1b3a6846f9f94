// SPDX-License-Identifier: Apache-2.0
// A fault: what it means, what to do, where it is written down, and Reset.
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import { button, el, setShown, setText } from "./dom";

const words = strings.fault;

export function faultCard(app: App): HTMLElement {
  const name = el("h2");
  const meaning = el("p", { class: "fault-meaning" });
  const remedy = el("p", {});
  const facts = el("p", { class: "hint" });
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const reset = button(words.reset, () => void go(), { class: "primary" });
  async function go(): Promise<void> {
    setText(error, refusal(await app.host.reset(app.store.state?.fault?.time ?? 0)));
    setShown(error, error.textContent !== "");
  }
  const element = el("section", { class: "fault-card", role: "alert" }, name, meaning, remedy, facts, error, el("div", { class: "buttons" }, reset));
  const update = () => {
    const fault = app.store.connected ? app.store.state?.fault : undefined;
    setShown(element, fault !== undefined);
    if (!fault) {
      setShown(error, false);
      return;
    }
    setText(name, `${words.title}: ${fault.name.replaceAll("_", " ")}`);
    setText(meaning, fault.meaning);
    setText(remedy, `${words.remedy}: ${fault.remedy}`);
    const parts = [
      fault.fromDevice ? words.fromDevice : "",
      fault.channel >= 0 ? words.channel(fault.channel) : "",
      `${words.report}: ${fault.report || words.reportPending}`,
    ];
    setText(facts, parts.filter((text) => text !== "").join(" · "));
    reset.disabled = !mayChange(app.store.role);
    reset.title = reset.disabled ? words.resetViewer : "";
  };
  app.store.on(["state", "connection"], update);
  update();
  return element;
}
