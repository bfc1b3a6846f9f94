// SPDX-License-Identifier: Apache-2.0
// What leaves the station: the report to print, the same values in FHIR, and the export. A report stands in a window of its own, which a lock
// or a sign-out closes.
import { ChoiceBox } from "../panels/choice_box";
import { button, el, section, setShown, setText } from "../panels/dom";
import { saveBlob } from "../panels/saving";
import { language } from "../strings";
import type { Course, ExportedFile, Patient } from "./shapes";
import { refusalText } from "./trouble";
import { dayName, stationLanguage, words } from "./words";

export interface DocumentActions {
  /// @param day  of the station's calendar, which is UTC; empty: all days
  report(day: string): Promise<string>;
  fhir(day: string): Promise<string>;
  export(): Promise<readonly ExportedFile[]>;
}

type SaveFile = (name: string, blob: Blob) => void;

const kText = "text/plain";

/// Windows with reports. None of them outlives the session.
export class ReportWindows {
  private readonly open: Window[] = [];

  /// Opens an empty window while the press of a button still permits it. @returns undefined: the browser forbids it
  begin(): Window | undefined {
    const opened = window.open("", "_blank");
    if (!opened) return undefined;
    opened.document.title = words.reading;
    this.open.push(opened);
    return opened;
  }

  closeAll(): void {
    for (const one of this.open.splice(0)) one.close();
  }
}

/// Puts a report into a window. Styles in the text would be refused by the page's Content-Security-Policy, which the window has, too. As style
/// sheets that are made by this page they are allowed.
export function showReport(target: Window & typeof globalThis, html: string): void {
  const parsed = new DOMParser().parseFromString(html, "text/html");
  const styles = [...parsed.querySelectorAll("style")].map((style) => style.textContent ?? "");
  for (const one of parsed.querySelectorAll("style, script, link, meta, base")) one.remove();
  const styled = [...parsed.querySelectorAll<HTMLElement>("[style]")].map((one) => [one, one.getAttribute("style") ?? ""] as const);
  for (const [one] of styled) one.removeAttribute("style");
  const { document } = target;
  document.documentElement.lang = parsed.documentElement.lang || stationLanguage;
  document.title = parsed.title;
  document.body.replaceChildren(...[...parsed.body.childNodes].map((node) => document.adoptNode(node)));
  document.body.className = parsed.body.className;
  for (const [one, text] of styled) one.style.cssText = text;
  document.adoptedStyleSheets = styles.map((text) => {
    const sheet = new target.CSSStyleSheet();
    sheet.replaceSync(text);
    return sheet;
  });
}

/// @param save  hands a file to the person
export function documentsSection(patient: Patient, course: Course, windows: ReportWindows, actions: DocumentActions, save: SaveFile = saveBlob): HTMLElement {
  const texts = words.documents;
  const said = el("p", { role: "status", hidden: true });
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const tell = (text: string) => {
    setText(said, text);
    setShown(said, text !== "");
    setShown(refused, false);
  };
  const run = (press: HTMLButtonElement, what: () => Promise<string>) => {
    press.disabled = true;
    tell(words.reading);
    void what()
      .then(tell)
      .catch((reason: unknown) => {
        tell("");
        setText(refused, refusalText(reason));
        setShown(refused, true);
      })
      .finally(() => (press.disabled = false));
  };
  const days = [...new Set([...course.results.map(({ date }) => dayName(date)), ...course.tests.map(({ date }) => date)])].filter((day) => day !== "").sort().reverse();
  const day = new ChoiceBox(() => {});
  day.name(texts.span);
  day.setChoices([{ value: "", text: texts.whole }, ...days.map((value) => ({ value, text: texts.oneDay(value) }))]);
  day.value = "";
  const named = (what: string) => `${patient.code}-${day.value || "course"}.${what}`;

  const report = button(texts.report, () => {
    const opened = windows.begin();
    run(report, async () => {
      try {
        const html = await actions.report(day.value);
        if (opened && !opened.closed) {
          showReport(opened as Window & typeof globalThis, html);
          return texts.opened;
        }
        save(named("html"), new Blob([html], { type: "text/html" }));
        return texts.blocked;
      } catch (reason) {
        opened?.close();
        throw reason;
      }
    });
  }, { class: "primary" });
  const keep = button(texts.keep, () =>
    run(keep, async () => {
      save(named("html"), new Blob([await actions.report(day.value)], { type: "text/html" }));
      return texts.saved(named("html"));
    }),
  );
  const fhir = button(texts.fhir, () =>
    run(fhir, async () => {
      save(named("fhir.json"), new Blob([await actions.fhir(day.value)], { type: "application/fhir+json" }));
      return texts.saved(named("fhir.json"));
    }),
  );
  const exports = button(texts.export, () =>
    run(exports, async () => {
      const files = await actions.export();
      for (const { name, type, text } of files) save(`${patient.code}-${name}`, new Blob([text], { type: type || kText }));
      return texts.saved(files.map(({ name }) => `${patient.code}-${name}`).join(", "));
    }),
  );
  return section(
    texts.title,
    days.length > 1 ? el("div", { class: "field document-day" }, el("span", { class: "quiet-text", "aria-hidden": "true" }, texts.span), day.button, day.list) : null,
    el("div", { class: "buttons" }, report, keep, fhir, exports),
    said,
    refused,
    el("p", { class: "hint" }, texts.hint),
  );
}

/// The language of a report: the page's.
export const reportLanguage = (): string => language.code;
