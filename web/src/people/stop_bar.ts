// SPDX-License-Identifier: Apache-2.0
// STOP on a page without a connection to the station's stream: by HTTP, again and again until the station has confirmed it. It needs no
// session, so that it works while the page is locked or signed out.
import { clockTime } from "../panels/as_text";
import { el, setAttribute, setShown, setText } from "../panels/dom";
import { onPress } from "../panels/press";
import { strings } from "../strings";
import { StopOrder } from "../wire/stop_order";
import { words } from "./words";

export interface StopBar {
  readonly element: HTMLElement;
  stop(): void;
}

/// @param post  one try; returns whether the station confirmed it
export function stopBar(post: () => Promise<boolean>): StopBar {
  const said = el("p", { class: "stop-said", role: "status", "aria-live": "assertive", hidden: true });
  const press = el(
    "button",
    { type: "button", class: "stop", "aria-describedby": "people-stop-note" },
    el("span", { class: "stop-word" }, strings.stop.button),
    el("span", { class: "stop-soft" }, `(${strings.stop.soft})`),
  );
  const order = new StopOrder(post, () => {
    const texts = { none: "", sent: strings.stop.sent, owed: strings.stop.failed, confirmed: strings.stop.confirmed(clockTime(Date.now() / 1000)) };
    setText(said, texts[order.progress]);
    setShown(said, order.progress !== "none");
    setAttribute(said, "data-bad", String(order.progress === "owed"));
  });
  const stop = () => order.press(undefined);
  onPress(press, stop);
  const note = el("p", { class: "stop-note", id: "people-stop-note" }, words.stop.note);
  return { element: el("section", { class: "people-stop", "aria-label": strings.stop.region }, press, el("div", {}, said, note)), stop };
}
