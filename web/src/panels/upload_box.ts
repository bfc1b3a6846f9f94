// SPDX-License-Identifier: Apache-2.0
// A mesh of one's own: choose, upload, read what the import says, use it.
import { quote } from "../state/toml";
import { strings } from "../strings";
import type { ImportReport } from "../wire/http";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, setShown, setText } from "./dom";
import { replaceObject } from "./object_change";
import { row } from "./setting_controls";

const words = strings.object;

/// The report in lines, for people.
export function reportLines(report: ImportReport): string[] {
  const facts = report.facts;
  if (!facts) return [...report.report];
  const count = (value: number) => value.toLocaleString("en");
  const extent = facts.extent.map((metres) => (metres * 1000).toFixed(1)).join(" × ");
  return [
    facts.verdict,
    words.counts(count(facts.vertices), count(facts.triangles)),
    words.extent(extent),
    facts.closed ? words.volume((facts.volume * 1e6).toFixed(1)) : words.open,
  ];
}
const kLimitBytes = 64 * 1024 * 1024; // Cockpit::kUploadLimit

export interface UploadBox {
  readonly element: HTMLElement;
  inForce(file: string): void;
}

export function uploadBox(app: App): UploadBox {
  const picker = el("input", { type: "file", accept: ".obj,.3ds,.stl,.ply,.glb", class: "visually-hidden", tabindex: -1, "aria-label": words.file });
  const choose = button(words.choose, () => picker.click());
  const chosen = el("p", { class: "hint" }, words.accepted);
  const size = el("input", { type: "text", inputmode: "decimal", class: "number", value: "100", autocomplete: "off" });
  const unit = new ChoiceBox(() => {});
  unit.setChoices(Object.entries(words.units).map(([value, text]) => ({ value, text })));
  unit.value = Object.keys(words.units)[0] ?? "";
  const unitRow = row(words.unit, unit).element;
  const send = button(words.upload, () => void upload(), { class: "primary" });
  const verdict = el("p", { class: "import-verdict", role: "status" });
  const error = el("p", { class: "refused" });
  const findings = el("ul", { class: "findings" });
  const findingsBox = el("div", {}, el("h3", {}, words.findings), findings);
  const report = el("pre", { class: "report", tabindex: 0, "aria-label": words.report });
  const use = button(words.useMesh, () => void apply(), { class: "primary" });
  const outcome = el("div", { class: "import" }, verdict, error, findingsBox, report, use);
  let done: ImportReport | null = null;

  const number = () => Math.max(0, Number(size.value.replace(",", ".")) || 0);

  function show(report_: ImportReport | null): void {
    done = report_;
    setShown(outcome, report_ !== null);
    if (!report_) return;
    setText(verdict, report_.ok ? words.good : words.bad);
    outcome.dataset["ok"] = String(report_.ok);
    setText(error, report_.error);
    setShown(error, report_.error !== "");
    findings.replaceChildren(...report_.findings.map((line) => el("li", {}, line)));
    setShown(findingsBox, report_.findings.length > 0);
    const text = reportLines(report_).filter((line) => line !== report_.error);
    setText(report, text.join("\n"));
    setShown(report, text.length > 0);
    setShown(use, report_.ok && report_.file !== "");
    use.disabled = false;
  }

  async function upload(): Promise<void> {
    const file = picker.files?.[0];
    if (!file) return picker.click();
    show(null);
    if (file.size > kLimitBytes) return show({ ok: false, error: words.tooLarge, report: [], facts: null, findings: [], file: "" });
    setText(chosen, words.uploading(file.name));
    send.disabled = true;
    try {
      show(await app.upload(file, number(), unit.value));
    } catch {
      show({ ok: false, error: words.noConnection, report: [], facts: null, findings: [], file: "" });
    }
    send.disabled = false;
    setText(chosen, file.name);
  }

  async function apply(): Promise<void> {
    if (!done?.ok) return;
    const entries: [string, string][] = [
      ["kind", quote("file")],
      ["file", quote(done.file)],
      ["size_mm", String(number())],
    ];
    if (number() === 0) entries.push(["unit", quote(unit.value)]);
    use.disabled = true;
    const refused = await change(app, replaceObject(app.store.state, entries));
    use.disabled = false;
    setText(error, refused);
    setShown(error, refused !== "");
  }

  picker.addEventListener("change", () => {
    setText(chosen, picker.files?.[0]?.name ?? words.accepted);
    show(null);
  });
  const showUnit = () => setShown(unitRow, number() === 0);
  size.addEventListener("input", showUnit);
  showUnit();
  show(null);

  const element = el(
    "div",
    { class: "upload" },
    el("div", { class: "buttons" }, choose, picker),
    chosen,
    row(words.size, size, strings.units.mm, words.sizeHint).element,
    unitRow,
    el("div", { class: "buttons" }, send),
    outcome,
  );
  const inForce = (file: string) => {
    if (!picker.files?.length && file !== "") setText(chosen, file.split("/").pop() ?? file);
  };
  return { element, inForce };
}
