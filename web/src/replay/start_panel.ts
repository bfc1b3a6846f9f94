// SPDX-License-Identifier: Apache-2.0
// The choice of a recording: those of the station, or a file of this computer.
import { button, el, newId, setShown, setText } from "../panels/dom";
import { strings } from "../strings";
import type { Listed, StationList } from "./station_list";
import { durationText, momentText, sizeText } from "../panels/as_text";
import { listTroubleText } from "./trouble";

const words = strings.replay;

export interface StartPanel {
  readonly element: HTMLElement;
  look(): Promise<void>; // asks the station for its list
  say(trouble: string): void; // why a recording could not be opened; empty: nothing
}

export interface StartActions {
  list(): Promise<StationList>;
  openListed(name: string): void;
  openFile(file: File): void;
}

function row(one: Listed, open: (name: string) => void): HTMLElement {
  const when = momentText(one.begin);
  const cell = (name: keyof typeof words.columns, text: string) => el("td", { "data-column": words.columns[name], class: `column-${name}` }, text);
  const name = one.opens
    ? button(when, () => open(one.name), { class: "primary", "aria-label": words.openOne(when, one.scene) })
    : el("span", { class: "not-whole" }, when, el("small", {}, one.state));
  return el(
    "tr",
    {},
    el("td", {}, name),
    cell("length", one.opens ? durationText(one.seconds, 0) : strings.dash),
    cell("scene", one.scene || strings.dash),
    cell("device", one.device || strings.dash),
    cell("events", one.opens ? String(one.events) : strings.dash),
    cell("gaps", one.opens ? String(one.gaps) : strings.dash),
    cell("size", sizeText(one.bytes)),
  );
}

export function startPanel(actions: StartActions): StartPanel {
  const trouble = el("p", { class: "refused", role: "alert", hidden: true });
  const said = el("p", { class: "hint", role: "status" });
  const body = el("tbody");
  const heads = Object.values(words.columns).map((text) => el("th", { scope: "col" }, text));
  const table = el("table", { class: "recordings", hidden: true }, el("thead", {}, el("tr", {}, ...heads)), body);
  const file = el("input", { type: "file", accept: ".mcap", hidden: true });
  file.addEventListener("change", () => {
    const chosen = file.files?.[0];
    file.value = ""; // the same file may be chosen again
    if (chosen) actions.openFile(chosen);
  });
  const again = button(words.again, () => void look());
  async function look(): Promise<void> {
    setText(said, words.reading);
    again.disabled = true;
    try {
      const { folder, recordings } = await actions.list();
      body.replaceChildren(...recordings.map((one) => row(one, actions.openListed)));
      setShown(table, recordings.length > 0);
      setText(said, recordings.length > 0 ? (folder ? words.stationFolder(folder) : "") : words.none);
    } catch (reason) {
      setText(said, listTroubleText(reason));
    }
    again.disabled = false;
  }
  const titles = [newId("start"), newId("start")] as const;
  return {
    element: el(
      "main",
      { class: "start" },
      trouble,
      el(
        "section",
        { class: "start-box", "aria-labelledby": titles[0] },
        el("header", {}, el("h2", { id: titles[0] }, words.station), again),
        said,
        el("div", { class: "recordings-scroll" }, table),
      ),
      el(
        "section",
        { class: "start-box", "aria-labelledby": titles[1] },
        el("h2", { id: titles[1] }, words.file),
        el("p", { class: "hint" }, words.fileHint),
        file,
        el("div", { class: "buttons" }, button(words.choose, () => file.click())),
      ),
    ),
    look,
    say(text) {
      setText(trouble, text);
      setShown(trouble, text !== "");
    },
  };
}
