// SPDX-License-Identifier: Apache-2.0
// The newest notice above Stop; faults stay until they are dismissed. What has a place of its own stays there.
import { Notice_Level, type Notice } from "../gen/phalanx/cockpit_pb";
import type { Store } from "../state/store";
import { strings } from "../strings";
import { clockTime } from "./as_text";
import { button, el } from "./dom";
import { eventWords, whoText } from "./plain_words";

const kShownMs = 6000;
const kAtOnce = 3;
const kShownElsewhere = new Set(["fault", "calibrate"]); // by code: on a card, in the wizard

export function toasts(store: Store): HTMLElement {
  const quiet = el("div", { class: "toast-list", role: "status", "aria-live": "polite", "aria-label": strings.notice.region });
  const loud = el("div", { class: "toast-list", role: "alert" });
  let seen: Notice | undefined;

  /// A change that this page has made is seen in its control, and a refusal stands beside it.
  const isOwn = ({ level, code, who }: Notice) =>
    (level === Notice_Level.CHANGE || code === "refused") && new RegExp(`^page ${store.welcome?.page ?? -1}\\b`).test(who);

  function show(notice: Notice): void {
    const fault = notice.level === Notice_Level.FAULT;
    const when = el("small", {}, `${clockTime(notice.unixTime)} ${whoText(notice.who, store.welcome?.page)}`);
    const toast = el(
      "div",
      { class: "toast", "data-level": Notice_Level[notice.level]?.toLowerCase() },
      el("div", {}, el("strong", {}, strings.notice.levels[notice.level] ?? ""), when, el("p", {}, eventWords(notice.code, notice.text))),
    );
    toast.append(button(strings.notice.dismiss, () => toast.remove(), { class: "quiet" }));
    const list = fault ? loud : quiet;
    list.prepend(toast);
    if (!fault) setTimeout(() => toast.remove(), kShownMs);
    while (list.childElementCount > kAtOnce) list.lastElementChild?.remove();
  }
  store.on(["notice"], () => {
    const last = store.notices.at(-1);
    // Events from before this page was opened are in the list; only new ones are shown as toasts.
    const now = last && last !== seen && !kShownElsewhere.has(last.code) && !store.welcome?.past.includes(last) && !isOwn(last);
    if (now) show(last);
    seen = last;
  });
  return el("div", { class: "toasts" }, loud, quiet);
}
