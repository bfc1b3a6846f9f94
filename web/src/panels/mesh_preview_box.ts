// SPDX-License-Identifier: Apache-2.0
// The place of a mesh's preview: its keys, and the text in place of a picture. It has a WebGL context only while it is open.
import type { UpAxis } from "../state/up_axis";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import type { MeshPreviewProbe, MeshPreviewView } from "../view3d/mesh_preview";
import type { ImportReport, MeshPreview } from "../wire/import_report";
import { el, setShown, setText } from "./dom";

const words = strings.object;
const kTurn = Math.PI / 16; // [rad] for a key

export class MeshPreviewBox {
  private readonly host = el("div", {
    class: "mesh-preview-host", tabindex: 0, role: "application", "aria-label": words.preview, hidden: true,
  });
  private readonly note = el("p", { class: "mesh-preview-note" }, words.previewEmpty);
  private readonly simplified = el("p", { class: "hint", hidden: true });
  readonly element = el(
    "div",
    { class: "mesh-preview" },
    el("div", { class: "mesh-preview-frame" }, this.host, this.note),
    this.simplified,
  );
  private mesh: MeshPreview | null = null;
  private view: MeshPreviewView | null = null;
  private wanted = 0; // counts what was to be drawn: an earlier one that comes late is not drawn
  private open = false;
  private up: UpAxis = "z";
  private theme: ThemeName = "dark";

  constructor() {
    this.host.addEventListener("keydown", (event) => {
      const turn: Readonly<Record<string, readonly [number, number]>> = {
        ArrowLeft: [-kTurn, 0],
        ArrowRight: [kTurn, 0],
        ArrowUp: [0, kTurn],
        ArrowDown: [0, -kTurn],
      };
      const step = turn[event.key];
      if (!step) return;
      this.view?.orbit(...step);
      event.preventDefault();
    });
  }

  /// @param report  null: none has come
  show(report: ImportReport | null): void {
    this.mesh = report?.ok ? report.preview : null;
    setText(this.note, report?.ok ? words.previewMissing : words.previewEmpty);
    const shown = (this.mesh?.index.length ?? 0) / 3;
    const all = report?.facts?.triangles ?? 0;
    const count = (triangles: number) => triangles.toLocaleString(strings.figures);
    setShown(this.simplified, shown > 0 && shown < all);
    setText(this.simplified, words.previewSimplified(count(shown), count(all)));
    void this.draw();
  }

  setUp(up: UpAxis): void {
    this.up = up;
    this.view?.setUp(up);
  }

  setTheme(theme: ThemeName): void {
    this.theme = theme;
    this.view?.setTheme(theme);
  }

  setOpen(open: boolean): void {
    this.open = open;
    void this.draw();
  }

  /// For tests and inspection; undefined: nothing is drawn.
  probe(): MeshPreviewProbe | undefined {
    return this.view?.probe();
  }

  private async draw(): Promise<void> {
    const mine = ++this.wanted;
    this.view?.dispose();
    this.view = null;
    const { mesh } = this;
    setShown(this.host, false);
    setShown(this.note, true);
    if (!mesh || !this.open) return;
    setText(this.note, words.previewLoading);
    try {
      const { MeshPreviewView } = await import("../view3d/mesh_preview");
      if (mine !== this.wanted) return;
      setShown(this.note, false);
      setShown(this.host, true);
      this.view = new MeshPreviewView(this.host, mesh, (trouble) => this.say(trouble !== "context-restored"));
      this.view.setUp(this.up);
      this.view.setTheme(this.theme);
    } catch (reason) {
      console.error(reason);
      if (mine === this.wanted) this.say(true);
    }
  }

  private say(failed: boolean): void {
    setText(this.note, words.previewFailed);
    setShown(this.note, failed);
    setShown(this.host, !failed);
  }
}
