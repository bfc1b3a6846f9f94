// SPDX-License-Identifier: Apache-2.0
// Over the view while what it shows is not alive.
import type { State } from "../gen/phalanx/cockpit_pb";
import type { Store } from "../state/store";
import { strings } from "../strings";
import { el, setShown, setText } from "./dom";
import { plainWords } from "./plain_words";
import { isStuck } from "./trouble_card";

export interface LostBand {
  readonly element: HTMLElement;
  update(now: number): void; // [ms]
}

function whySilent(state: State | undefined): string {
  if (state?.wizard) return strings.lost.calibrating;
  if (isStuck(state)) return ""; // the card states it
  return plainWords(state?.trouble ?? "") || (state?.busy ? strings.busy(plainWords(state.busy)) : "");
}

export function lostBand(store: Store): LostBand {
  const title = el("strong", { role: "alert" });
  const since = el("span");
  const why = el("p");
  const element = el("div", { class: "lost-band", hidden: true }, title, since, why);
  const update = (now: number) => {
    setShown(element, store.viewDead && !store.busyWithItself);
    if (element.hidden) return;
    const words = strings.lost;
    const fresh = store.freshness;
    const seconds = (fresh.age(now) / 1000).toFixed(fresh.age(now) < 10_000 ? 1 : 0);
    const age = fresh.ever ? words.since(seconds) : "";
    if (!store.lost) {
      setText(title, words.shape);
      setText(since, "");
      setText(why, words.shapeWhy);
    } else if (store.phase === "replaced") {
      setText(title, words.replaced);
      setText(since, "");
      setText(why, words.replacedWhy);
    } else if (store.phase === "expired") {
      setText(title, words.expired);
      setText(since, age);
      setText(why, words.expiredWhy);
    } else if (store.phase === "mismatch") {
      setText(title, words.closed);
      setText(since, "");
      setText(why, words.mismatch);
    } else if (store.unmeasured) {
      setText(title, words.unmeasured);
      setText(since, fresh.ever ? words.measured(seconds) : "");
      setText(why, whySilent(store.state) || words.unmeasuredWhy);
    } else if (store.connected) {
      setText(title, words.stale);
      setText(since, age);
      setText(why, whySilent(store.state));
    } else {
      setText(title, fresh.ever ? words.closed : words.connecting);
      setText(since, fresh.ever ? words.retry(age) : "");
      setText(why, fresh.ever ? words.device : "");
    }
    setShown(why, why.textContent !== "");
  };
  return { element, update };
}
