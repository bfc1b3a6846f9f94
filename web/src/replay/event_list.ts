// SPDX-License-Identifier: Apache-2.0
// What happened in a recording: markers, faults, stops, changes, gaps. A press goes there.
import { button, el, setAttribute, setShown, setSwitch, setText, switchButton } from "../panels/dom";
import { eventWords, whoText } from "../panels/plain_words";
import { eventLabel, markKind, type MarkKind } from "../state/happened";
import { strings } from "../strings";
import type { Overview } from "./overview";
import { durationText } from "../panels/as_text";

const words = strings.replay;
const kMostShown = 1000; // of the list; a longer one would hold up the page

export interface Happening {
  readonly time: number; // [s]
  readonly code: string;
  readonly kind: MarkKind;
  readonly label: string;
  readonly text: string;
  readonly who?: string; // did it; absent: the recording
}

/// Everything of the overview that a person may look for, in the order of time.
export function happenings({ events, stations, holes }: Pick<Overview, "events" | "stations" | "holes">): Happening[] {
  const list: Happening[] = [
    ...stations.map(({ time, value: { scene, device } }) => ({
      time, code: "station", kind: "other" as const, label: eventLabel("station"), text: words.stationBegins(scene, device),
    })),
    ...events.map(({ time, value: { code, who, text } }) => ({
      time, code, kind: markKind(code), label: eventLabel(code), text, who,
    })),
    ...holes.map(({ begin, gap }) => ({
      time: begin, code: "gap", kind: "gap" as const, label: eventLabel("gap"), text: words.missing(gap.steps.toLocaleString(strings.figures), gap.why),
    })),
  ];
  return list.sort((a, b) => a.time - b.time);
}

/// What happened, and who did it.
export function happeningText({ code, text, who }: Happening): string {
  const what = eventWords(code, text);
  return who && code !== "marker" ? words.by(what, whoText(who)) : what;
}

export interface EventList {
  readonly element: HTMLElement;
  /// @param complete  there will be no more
  show(list: readonly Happening[], complete: boolean): void;
  update(position: number): void; // marks the newest event at that time
}

export function eventList(goTo: (time: number) => void): EventList {
  let all: readonly Happening[] = [];
  let rows: { readonly time: number; readonly button: HTMLElement }[] = [];
  let current: HTMLElement | undefined;
  let markersOnly = false;
  const list = el("ol", { class: "happenings" });
  let known = ""; // what `list` was built of
  const none = el("p", { class: "hint" }, words.reading);
  const more = el("p", { class: "hint", hidden: true });
  const only = switchButton(words.onlyMarkers, (on) => {
    markersOnly = on;
    setSwitch(only, on);
    build();
  });
  function row(one: Happening): HTMLElement {
    const made = button("", () => goTo(one.time), { class: "happening", "data-kind": one.kind });
    made.append(
      el("span", { class: "happening-time" }, durationText(one.time)),
      el("span", { class: "happening-mark", "aria-hidden": "true" }),
      el("span", { class: "happening-label" }, one.label),
      el("span", { class: "happening-text" }, happeningText(one)),
    );
    rows.push({ time: one.time, button: made });
    return el("li", {}, made);
  }
  function build(): void {
    rows = [];
    current = undefined;
    const shown = all.filter(({ kind }) => !markersOnly || kind === "marker");
    list.replaceChildren(...shown.slice(0, kMostShown).map(row));
    setText(more, words.moreEvents(kMostShown.toLocaleString(strings.figures), shown.length.toLocaleString(strings.figures)));
    setShown(more, shown.length > kMostShown);
    setShown(none, shown.length === 0);
    setShown(only, all.some(({ kind }) => kind === "marker"));
  }
  build();
  return {
    element: el("div", { class: "event-list" }, only, none, list, more),
    show(next, complete) {
      setText(none, complete ? words.noEvents : words.reading);
      const content = JSON.stringify(next);
      if (content === known) return; // a press and the focus outlast what does not change
      known = content;
      all = next;
      build();
    },
    update(position) {
      let newest: HTMLElement | undefined;
      for (const { time, button: made } of rows) if (time <= position + 1e-6) newest = made;
      if (newest === current) return;
      if (current) setAttribute(current, "aria-current", null);
      if (newest) setAttribute(newest, "aria-current", "true");
      current = newest;
    },
  };
}
