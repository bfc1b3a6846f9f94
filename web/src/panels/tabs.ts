// SPDX-License-Identifier: Apache-2.0
// One panel at a time, chosen by tabs; arrow keys go from tab to tab.
import { strings } from "../strings";
import { el, newId } from "./dom";

export interface Tab {
  readonly name: string;
  readonly text: string;
  readonly panel: HTMLElement;
}

export function tabs(all: readonly Tab[]): HTMLElement {
  const buttons = all.map((tab) => {
    const id = newId("tab");
    tab.panel.id = `${id}-panel`;
    tab.panel.setAttribute("role", "tabpanel");
    tab.panel.setAttribute("aria-labelledby", id);
    tab.panel.classList.add("tab-panel");
    tab.panel.tabIndex = 0; // keys scroll it also where a viewer can use none of its controls
    const button = el("button", { type: "button", role: "tab", id, "aria-controls": tab.panel.id, "data-tab": tab.name }, tab.text);
    button.addEventListener("click", () => choose(tab.name));
    return button;
  });
  const list = el("div", { class: "tabs", role: "tablist", "aria-label": strings.tabs.label }, ...buttons);
  list.addEventListener("keydown", (event) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    const now = buttons.findIndex((button) => button.getAttribute("aria-selected") === "true");
    const next = (now + step + buttons.length) % buttons.length;
    choose(all[next]?.name ?? "");
    buttons[next]?.focus();
    event.preventDefault();
  });
  function choose(name: string): void {
    all.forEach((tab, i) => {
      const chosen = tab.name === name;
      buttons[i]?.setAttribute("aria-selected", String(chosen));
      buttons[i]?.setAttribute("tabindex", chosen ? "0" : "-1");
      tab.panel.hidden = !chosen;
    });
  }
  choose(all[0]?.name ?? "");
  return el("div", { class: "tabbed" }, list, el("div", { class: "tab-panels" }, ...all.map((tab) => tab.panel)));
}
