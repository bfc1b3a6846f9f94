// SPDX-License-Identifier: Apache-2.0
// An object of the user's own: a dialog for its mesh file, and the view as a place to drop one.
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import type { ThemeName } from "../theme";
import type { MeshPreviewProbe } from "../view3d/mesh_preview";
import type { App } from "./app";
import { openDialog, type OpenDialog } from "./dialog";
import { el, setShown } from "./dom";
import { guarded } from "./setting_controls";
import { uploadBox } from "./upload_box";

const words = strings.object;

export interface OwnObject {
  /// Opens the dialog. @param file  that is uploaded at once; absent: the user chooses one
  open(file?: File): void;
  setTheme(theme: ThemeName): void;
  preview(): MeshPreviewProbe | undefined;
}

export function ownObject(app: App): OwnObject {
  let dialog: OpenDialog | undefined;
  const box = uploadBox(app, () => dialog?.close());
  const content = guarded(app, box.element);
  return {
    open(file) {
      dialog = openDialog(app, words.own, [content], () => box.setOpen(false));
      takeFiles(app, dialog.element, (on) => box.element.toggleAttribute("data-drop", on), box.take);
      box.setOpen(true);
      if (file) box.take(file);
    },
    setTheme: box.setTheme,
    preview: box.probe,
  };
}

/// Makes the view a place where a mesh file can be dropped.
/// @returns the notice that lies over the view while a file is dragged
export function dropPlace(app: App, view: HTMLElement, own: OwnObject): HTMLElement {
  const notice = el("p", { class: "drop-notice", hidden: true }, words.drop);
  takeFiles(app, view, (on) => setShown(notice, on), (file) => own.open(file));
  keepPage();
  return notice;
}

const isFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;

/// Takes files that are dropped on an element while this page has control.
/// @param show  called with whether one is dragged over it
function takeFiles(app: App, place: HTMLElement, show: (on: boolean) => void, take: (file: File) => void): void {
  place.addEventListener("dragover", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    show(mayChange(app.store.role));
  });
  place.addEventListener("dragleave", (event) => {
    if (!(event.relatedTarget instanceof Node && place.contains(event.relatedTarget))) show(false);
  });
  place.addEventListener("drop", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    show(false);
    const file = event.dataTransfer?.files[0];
    if (file && mayChange(app.store.role)) take(file);
  });
}

/// Refuses files elsewhere on the page: the browser would show the file in place of the page and its Stop.
function keepPage(): void {
  window.addEventListener("dragover", (event) => {
    if (!isFile(event) || event.defaultPrevented) return;
    event.preventDefault();
    if (event.dataTransfer) event.dataTransfer.dropEffect = "none";
  });
  window.addEventListener("drop", (event) => isFile(event) && event.preventDefault());
}
