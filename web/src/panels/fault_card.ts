// SPDX-License-Identifier: Apache-2.0
// A fault: what it means, what to do, where it is written down, and Reset. Over the view, and in the device panel.
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import { button, el, section, setShown, setText } from "./dom";

const words = strings.fault;

/// @param changed  whether there is a fault
function faultBody(app: App, heading: "h2" | "h3", changed: (present: boolean) => void): HTMLElement {
  const name = el(heading, { class: "fault-name" });
  const meaning = el("p");
  const remedy = el("p");
  const facts = el("p", { class: "hint" });
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const reset = button(words.reset, () => void go(), { class: "primary" });
  async function go(): Promise<void> {
    setText(error, refusal(await app.host.reset(app.store.state?.fault?.time ?? 0)));
    setShown(error, error.textContent !== "");
  }
  const element = el("div", { class: "fault" }, name, meaning, remedy, facts, error, el("div", { class: "buttons" }, reset));
  const update = () => {
    const fault = app.store.connected ? app.store.state?.fault : undefined;
    setShown(element, fault !== undefined);
    changed(fault !== undefined);
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

/// Over the view, while there is a fault.
export function faultCard(app: App): HTMLElement {
  const element = el("section", { class: "fault-card", role: "alert" });
  element.append(faultBody(app, "h2", (present) => setShown(element, present)));
  return element;
}

/// In the device panel, always: also that there is none.
export function faultSection(app: App): HTMLElement {
  const none = el("p", { class: "hint" });
  const body = faultBody(app, "h3", (present) => {
    setShown(none, !present);
    setText(none, app.store.connected && app.store.state ? words.none : strings.dash);
  });
  return section(words.title, none, body);
}
