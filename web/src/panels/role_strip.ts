// SPDX-License-Identifier: Apache-2.0
// Why nothing can be changed here, in one line, and the way to change that. What is being worked at.
import { mayTake } from "../state/roles";
import { strings } from "../strings";
import type { App } from "./app";
import { button, el, setAttribute, setShown, setText } from "./dom";
import { pageName, plainWords } from "./plain_words";

/// Name of the operator, as text.
export function operatorName(app: App): string {
  const state = app.store.state;
  if (!state || state.operatorPage === 0) return strings.nobody;
  return pageName(state.operatorPage, state.operatorName);
}

export function roleText(app: App): string {
  const role = app.store.role;
  return role === "other" ? strings.role.other(operatorName(app)) : strings.role[role];
}

export function roleStrip(app: App): HTMLElement {
  const text = el("span");
  const take = button(strings.role.take, app.takeControl, { class: "primary" });
  const busy = el("p", { class: "busy", role: "status" });
  const why = el("div", { class: "role-why", role: "status" }, text, take);
  const element = el("div", { class: "role-strip" }, why, busy);
  const update = () => {
    const role = app.store.role;
    setText(text, roleText(app));
    setShown(why, role !== "mine");
    setShown(take, mayTake(role));
    const working = app.store.connected ? (app.store.state?.busy ?? "") : "";
    setText(busy, working === "" ? "" : strings.busy(plainWords(working)));
    setShown(busy, working !== "");
    setAttribute(element, "data-role", role);
  };
  app.store.on(["state", "connection"], update);
  update();
  return element;
}
