// SPDX-License-Identifier: Apache-2.0
// An object of the user's own: a dialog for its mesh file, and the view as a place to drop one.
import { mayChange } from "../state/roles";
import { strings } from "../strings";
import type { App } from "./app";
import { openDialog, type OpenDialog } from "./dialog";
import { el, setShown } from "./dom";
import { guarded } from "./setting_controls";
import { uploadBox } from "./upload_box";

const words = strings.object;

export interface OwnObject {
  /// Opens the dialog. @param file  that is uploaded at once; absent: the user chooses one
  open(file?: File): void;
}

export function ownObject(app: App): OwnObject {
  let dialog: OpenDialog | undefined;
  const box = uploadBox(app, () => dialog?.close());
  const content = guarded(app, box.element);
  return {
    open(file) {
      dialog = openDialog(app, words.own, [content]);
      if (file) box.take(file);
    },
  };
}

/// Makes the view a place where a mesh file can be dropped.
/// @returns the notice that lies over the view while a file is dragged
export function dropPlace(app: App, view: HTMLElement, own: OwnObject): HTMLElement {
  const notice = el("p", { class: "drop-notice", hidden: true }, words.drop);
  const isFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
  const show = (on: boolean) => setShown(notice, on && mayChange(app.store.role));
  view.addEventListener("dragover", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    show(true);
  });
  view.addEventListener("dragleave", (event) => {
    if (!(event.relatedTarget instanceof Node && view.contains(event.relatedTarget))) show(false);
  });
  view.addEventListener("drop", (event) => {
    if (!isFile(event)) return;
    event.preventDefault();
    show(false);
    const file = event.dataTransfer?.files[0];
    if (file && mayChange(app.store.role)) own.open(file);
  });
  return notice;
}
