// SPDX-License-Identifier: Apache-2.0
import { beforeEach, describe, expect, it, vi } from "vitest";
import { documentsSection, ReportWindows, showReport } from "../../../src/people/documents";
import { words } from "../../../src/people/words";
import { FakeApi } from "./fake_api";

const station = new FakeApi();
const patient = station.kept[0]!;
let saved: { readonly name: string; readonly text: Promise<string>; readonly type: string }[] = [];
let section: HTMLElement;

const flush = () => new Promise((resolve) => setTimeout(resolve, 5));
const said = () => [...section.querySelectorAll<HTMLElement>("[role=status]:not([hidden]), [role=alert]:not([hidden])")].map((one) => one.textContent).join("; ");
async function press(text: string): Promise<void> {
  [...section.querySelectorAll("button")].find((one) => one.textContent === text)!.click();
  await flush();
}

beforeEach(() => {
  saved = [];
  station.signedIn = true;
  station.refuse = undefined;
  station.asked.length = 0;
  section = documentsSection(patient, station.measured, new ReportWindows(), {
    report: (day) => station.report(patient.record, "en", day), fhir: (day) => station.fhir(patient.record, day), export: () => station.export(patient.record),
  }, (name, blob) => void saved.push({ name, text: blob.text(), type: blob.type }));
  document.body.replaceChildren(section);
});

describe("what leaves the station", () => {
  it("is the export: three files by the patient's code", async () => {
    await press(words.documents.export);
    expect(saved.map(({ name }) => name)).toEqual(["P07-patient.json", "P07-results.csv", "P07-tests.csv"]);
    expect(await saved[1]!.text).toBe("results.csv");
    expect(said()).toContain("P07-tests.csv");
  });

  it("is the report or the FHIR bundle, of one day if that is chosen", async () => {
    section.querySelector<HTMLElement>(".choice")!.click();
    [...section.querySelectorAll<HTMLElement>("[role=option]")].find((one) => one.dataset["value"] === "2026-05-04")!.click();
    await press(words.documents.fhir);
    await press(words.documents.keep);
    expect(station.asked).toEqual(["fhir aa 2026-05-04", "report aa en 2026-05-04"]);
    expect(saved.map(({ name, type }) => [name, type])).toEqual([["P07-2026-05-04.fhir.json", "application/fhir+json"], ["P07-2026-05-04.html", "text/html"]]);
  });

  it("is saved as a file where the browser permits no window, and the station's refusal is shown", async () => {
    const open = vi.spyOn(window, "open").mockReturnValue(null);
    await press(words.documents.report);
    expect(saved.map(({ name }) => name)).toEqual(["P07-course.html"]);
    expect(said()).toContain(words.documents.blocked);
    station.refuse = { trouble: "refused", message: "the disk is full" };
    await press(words.documents.export);
    expect(said()).toContain("the disk is full");
    open.mockRestore();
  });
});

describe("a report in its window", () => {
  it("has its styles from this page, since the station forbids those in the text, and no script", () => {
    const target = window as Window & typeof globalThis;
    const made = document.implementation.createHTMLDocument("empty");
    const sheets: string[] = [];
    class Sheet {
      replaceSync = (text: string) => void sheets.push(text);
    }
    const frame = { document: made, CSSStyleSheet: Sheet } as unknown as typeof target;
    showReport(frame, "<!doctype html><html lang='de'><head><title>P07</title><style>p { margin: 0 }</style></head><body class='a4'><p style='color: red'>4.25 N</p><script>1</script></body></html>");
    expect([made.title, made.documentElement.lang, made.body.className, made.body.textContent]).toEqual(["P07", "de", "a4", "4.25 N"]);
    expect(sheets).toEqual(["p { margin: 0 }"]);
    expect(made.querySelector("style, script")).toBeNull();
    expect(made.querySelector("p")!.style.color).toBe("red");
  });

  it("is closed with the session", () => {
    const opened = { document: document.implementation.createHTMLDocument(""), close: vi.fn() };
    const open = vi.spyOn(window, "open").mockReturnValue(opened as unknown as Window);
    const windows = new ReportWindows();
    windows.begin();
    windows.closeAll();
    windows.closeAll();
    expect(opened.close).toHaveBeenCalledTimes(1);
    open.mockRestore();
  });
});
