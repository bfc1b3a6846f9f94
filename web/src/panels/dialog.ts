// SPDX-License-Identifier: Apache-2.0
// Dialogs that leave the rest of the page alive: Stop is never behind one.
import { strings } from "../strings";
import { button, el, newId } from "./dom";

/// The place of dialogs.
export interface DialogHost {
  readonly dialogs: HTMLElement; // never over Stop
}

export interface OpenDialog {
  readonly element: HTMLElement;
  close(): void;
}

/// Opens over the view. The focus goes in, and back when it closes.
export function openDialog(app: DialogHost, title: string, content: readonly Node[], closed: () => void = () => {}): OpenDialog {
  for (const open of app.dialogs.querySelectorAll<HTMLElement>(".dialog")) open.dispatchEvent(new Event("phalanx-close"));
  const before = document.activeElement;
  const id = newId("dialog");
  const close = () => {
    if (!element.isConnected) return;
    element.remove();
    app.dialogs.hidden = true;
    closed();
    if (before instanceof HTMLElement && before.isConnected) before.focus();
  };
  const element = el(
    "div",
    { class: "dialog", role: "dialog", "aria-labelledby": id, tabindex: -1 },
    el("div", { class: "dialog-head" }, el("h2", { id }, title), button(strings.look.close, close, { class: "quiet" })),
    el("div", { class: "dialog-body" }, ...content),
  );
  element.addEventListener("phalanx-close", close);
  app.dialogs.append(element);
  app.dialogs.hidden = false;
  element.focus();
  return { element, close };
}

/// Opens a dialog; `yes` runs when it is confirmed.
export function confirmDialog(app: DialogHost, title: string, text: string, confirm: string, yes: () => void): void {
  const sure = button(confirm, () => {
    dialog.close();
    yes();
  }, { class: "primary" });
  const cancel = button(strings.role.cancel, () => dialog.close());
  const dialog = openDialog(app, title, [el("p", {}, text), el("div", { class: "buttons" }, sure, cancel)]);
  sure.focus();
}

/// Lists the keys of a page and what they do.
export function helpDialog(app: DialogHost, title: string, rows: readonly (readonly [string, string])[], note: string): void {
  const list = el("dl", { class: "keys", tabindex: 0 }); // keys scroll it where it is longer than the dialog
  for (const [key, meaning] of rows) list.append(el("dt", {}, el("kbd", {}, key)), el("dd", {}, meaning));
  openDialog(app, title, [list, el("p", { class: "hint" }, note)]);
}
