// SPDX-License-Identifier: Apache-2.0
// Upload of a mesh: choose a file, upload it, see what the import made of it, use the mesh.
import { KeyType } from "../gen/phalanx/cockpit_pb";
import { fromTyped, quote } from "../state/toml";
import { uprightRotation, usualUpAxis } from "../state/up_axis";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import type { MeshPreviewProbe } from "../view3d/mesh_preview";
import { refusedReport, type ImportReport } from "../wire/import_report";
import { change, type App } from "./app";
import { ChoiceBox } from "./choice_box";
import { button, el, setShown, setText } from "./dom";
import { graspOfNextObject } from "./grasp_section";
import { importSummary, reportLines } from "./import_words";
import { MeshPreviewBox } from "./mesh_preview_box";
import { replaceObject } from "./object_change";
import { row } from "./setting_controls";
import { UpAxisChoice } from "./up_axis_choice";

const words = strings.object;
const kLimitBytes = 64 * 1024 * 1024; // Cockpit::kUploadLimit
/// For the way of the largest file and the longest import [ms].
export const kUploadPatienceMs = 600_000;

export interface UploadBox {
  readonly element: HTMLElement;
  /// Takes a file that was dropped, and uploads it.
  take(file: File): void;
  /// The dialog has opened, or closed: an upload goes on, but nothing is drawn.
  setOpen(open: boolean): void;
  setTheme(theme: ThemeName): void;
  probe(): MeshPreviewProbe | undefined;
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
  const preview = new MeshPreviewBox();
  const up = new UpAxisChoice(() => preview.setUp(up.value));
  const summary = el("p", { class: "import-summary", role: "status" });
  const error = el("p", { class: "refused", hidden: true });
  const use = button(words.useMesh, () => void apply(), { class: "primary" });
  const findings = el("ul", { class: "findings" });
  const findingsBox = el("div", {}, el("h3", {}, words.findings), findings);
  const report = el("pre", { class: "report", tabindex: 0, role: "group", "aria-label": words.report });
  const details = el("details", {}, el("summary", {}, words.details), findingsBox, report);
  const outcome = el("div", { class: "import" }, summary, error, el("div", { class: "buttons" }, use), details);
  let dropped: File | undefined; // in place of a chosen one
  let done: ImportReport | null = null; // of the file, size and unit that are shown
  let running: AbortController | null = null; // the upload whose answer is awaited

  const wanted = () => dropped ?? picker.files?.[0];
  const number = () => Math.max(0, Number(fromTyped(size.value, KeyType.KEY_NUMBER)) || 0);

  /// @param report_  null: none has come
  function show(report_: ImportReport | null): void {
    done = report_;
    preview.show(report_);
    setShown(outcome, report_ !== null);
    if (!report_) return;
    const sentence = importSummary(wanted()?.name ?? "", report_);
    setText(summary, sentence);
    outcome.dataset["ok"] = String(report_.ok);
    setShown(error, false);
    findings.replaceChildren(...report_.findings.map((line) => el("li", {}, line)));
    setShown(findingsBox, report_.findings.length > 0);
    const text = reportLines(report_).filter((line) => line !== sentence);
    setText(report, text.join("\n"));
    setShown(report, text.length > 0);
    details.open = false;
    setShown(details, text.length + report_.findings.length > 0);
    setShown(use, report_.ok && report_.file !== "");
    use.disabled = false;
  }

  /// Handles another file, size or unit: the report is removed, and a running upload is abandoned.
  function outdated(): void {
    running?.abort();
    running = null;
    send.disabled = false;
    const file = wanted();
    if (file) setText(chosen, file.name);
    show(null);
  }

  function otherFile(): void {
    up.value = usualUpAxis(wanted()?.name ?? "");
    preview.setUp(up.value);
    outdated();
  }

  async function upload(): Promise<void> {
    const file = wanted();
    if (!file) return picker.click();
    outdated();
    if (file.size > kLimitBytes) return show(refusedReport(words.tooLarge));
    const mine = new AbortController();
    running = mine;
    const patience = setTimeout(() => mine.abort(), kUploadPatienceMs);
    setText(chosen, words.uploading(file.name));
    send.disabled = true;
    const answer = await app.upload(file, number(), unit.value, mine.signal).catch(() => refusedReport(words.noConnection));
    clearTimeout(patience);
    if (running !== mine) return; // it was given up
    outdated();
    show(answer);
    outcome.scrollIntoView?.({ block: "nearest" });
  }

  async function apply(): Promise<void> {
    if (!done?.ok) return;
    const entries: [string, string][] = [
      ["kind", quote("file")],
      ["file", quote(done.file)],
      ["size_mm", String(number())],
      ["rotation_deg", `[${uprightRotation[up.value].join(", ")}]`],
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
    otherFile();
  });
  app.store.on(["connection"], () => !app.store.connected && running?.abort());
  const showUnit = () => setShown(unitRow, number() === 0);
  size.addEventListener("input", showUnit);
  size.addEventListener("input", outdated);
  showUnit();
  show(null);

  const file = el(
    "div",
    { class: "upload-file" },
    el("div", { class: "buttons" }, choose, picker),
    chosen,
    row(words.size, size, strings.units.mm, words.sizeHint).element,
    unitRow,
    el("div", { class: "buttons" }, send),
  );
  const seen = el("div", { class: "upload-seen" }, preview.element, up.element);
  return {
    element: el("div", { class: "upload" }, el("div", { class: "upload-parts" }, file, seen, outcome)),
    take(taken) {
      dropped = taken;
      otherFile();
      void upload();
    },
    setOpen: (open) => preview.setOpen(open),
    setTheme: (theme) => preview.setTheme(theme),
    probe: () => preview.probe(),
  };
}
