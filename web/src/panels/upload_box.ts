// SPDX-License-Identifier: Apache-2.0
// Upload of a mesh: choose a file, upload it, read the import's report, use the mesh.
import { KeyType } from "../gen/phalanx/cockpit_pb";
import { fromTyped, quote } from "../state/toml";
import { strings } from "../strings";
import type { ImportReport } from "../wire/http";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, setShown, setText } from "./dom";
import { graspOfNextObject } from "./grasp_section";
import { replaceObject } from "./object_change";
import { row } from "./setting_controls";

const words = strings.object;

/// Writes the report in lines.
export function reportLines(report: ImportReport): string[] {
  const facts = report.facts;
  if (!facts) return [...report.report];
  const count = (value: number) => value.toLocaleString(strings.locale);
  const extent = facts.extent.map((metres) => (metres * 1000).toFixed(1)).join(" × ");
  return [
    facts.verdict,
    words.counts(count(facts.vertices), count(facts.triangles)),
    words.extent(extent),
    facts.closed ? words.volume((facts.volume * 1e6).toFixed(1)) : words.open,
  ];
}
const kLimitBytes = 64 * 1024 * 1024; // Cockpit::kUploadLimit
/// For the way of the largest file and the longest import [ms].
export const kUploadPatienceMs = 600_000;

export interface UploadBox {
  readonly element: HTMLElement;
  /// Takes a file that was dropped, and uploads it.
  take(file: File): void;
}

/// @param used  called when the station has taken the mesh
export function uploadBox(app: App, used: () => void = () => {}): UploadBox {
  const picker = el("input", { type: "file", accept: ".obj,.3ds,.stl,.ply,.glb", class: "visually-hidden", tabindex: -1, "aria-label": words.file });
  const choose = button(words.choose, () => picker.click());
  const chosen = el("p", { class: "hint" }, words.accepted);
  const size = el("input", { type: "text", inputmode: "decimal", class: "number", value: "100", autocomplete: "off" });
  const unit = new ChoiceBox(() => outdated());
  unit.setChoices(Object.entries(words.units).map(([value, text]) => ({ value, text })));
  unit.value = Object.keys(words.units)[0] ?? "";
  const unitRow = row(words.unit, unit).element;
  const send = button(words.upload, () => void upload(), { class: "primary" });
  const verdict = el("p", { class: "import-verdict", role: "status" });
  const error = el("p", { class: "refused" });
  const findings = el("ul", { class: "findings" });
  const findingsBox = el("div", {}, el("h3", {}, words.findings), findings);
  const report = el("pre", { class: "report", tabindex: 0, role: "group", "aria-label": words.report });
  const use = button(words.useMesh, () => void apply(), { class: "primary" });
  const outcome = el("div", { class: "import" }, verdict, error, findingsBox, report, use);
  let dropped: File | undefined; // in place of a chosen one
  let done: ImportReport | null = null; // of the file, size and unit that are shown
  let running: AbortController | null = null; // the upload whose answer is awaited

  const wanted = () => dropped ?? picker.files?.[0];
  const number = () => Math.max(0, Number(fromTyped(size.value, KeyType.KEY_NUMBER)) || 0);

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

  const failed = (why: string): ImportReport => ({ ok: false, error: why, report: [], facts: null, findings: [], file: "" });

  /// Handles another file, size or unit: the report is removed, and a running upload is abandoned.
  function outdated(): void {
    running?.abort();
    running = null;
    send.disabled = false;
    const file = wanted();
    if (file) setText(chosen, file.name);
    show(null);
  }

  async function upload(): Promise<void> {
    const file = wanted();
    if (!file) return picker.click();
    outdated();
    if (file.size > kLimitBytes) return show(failed(words.tooLarge));
    const mine = new AbortController();
    running = mine;
    const patience = setTimeout(() => mine.abort(), kUploadPatienceMs);
    setText(chosen, words.uploading(file.name));
    send.disabled = true;
    const answer = await app.upload(file, number(), unit.value, mine.signal).catch(() => failed(words.noConnection));
    clearTimeout(patience);
    if (running !== mine) return; // it was given up
    outdated();
    show(answer);
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
    const refused = await change(app, [...replaceObject(app.store.state, entries), ...graspOfNextObject(app)]);
    use.disabled = false;
    setText(error, refused);
    setShown(error, refused !== "");
    if (refused === "") used();
  }

  picker.addEventListener("change", () => {
    dropped = undefined;
    setText(chosen, words.accepted);
    outdated();
  });
  app.store.on(["connection"], () => !app.store.connected && running?.abort());
  const showUnit = () => setShown(unitRow, number() === 0);
  size.addEventListener("input", showUnit);
  size.addEventListener("input", outdated);
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
  const take = (file: File) => {
    dropped = file;
    void upload();
  };
  return { element, take };
}
