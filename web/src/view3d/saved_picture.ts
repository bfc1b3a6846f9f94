// SPDX-License-Identifier: Apache-2.0
// The picture of the view that is saved: what is drawn, and the words and figures that the page lays over it.
import type { PlacedLabel } from "./force_labels";

const kMarkSize = 0.05; // height of the mark's letters, of the picture's
const kLabelType = 12; // of a force's figure [pixels of the style sheet]
const kLabelBase = 13; // of its base line, from the label's upper edge

/// A copy of the canvas with words in its upper left corner and figures at the arrows; without either the canvas itself.
/// @param labels  in a picture of this height [pixels of the style sheet]
export function savedPicture(canvas: HTMLCanvasElement, mark: string, labels: readonly PlacedLabel[], height: number): HTMLCanvasElement {
  const copy = document.createElement("canvas");
  const context = mark || labels.length > 0 ? copy.getContext("2d") : null;
  if (!context) return canvas;
  [copy.width, copy.height] = [canvas.width, canvas.height];
  context.drawImage(canvas, 0, 0);
  context.strokeStyle = "black"; // legible on every background
  context.fillStyle = "white";
  const write = (text: string, size: number, style: string, left: number, top: number) => {
    context.font = `${style} ${size}px system-ui, sans-serif`;
    context.lineWidth = size / 6;
    context.strokeText(text, left, top);
    context.fillText(text, left, top);
  };
  const size = Math.round(kMarkSize * copy.height);
  if (mark) write(mark, size, "600", size, 2 * size);
  const scale = copy.height / Math.max(1, height);
  for (const { label, left, top } of labels) {
    write(label.text, kLabelType * scale, label.felt ? "600" : "italic 400", left * scale, (top + kLabelBase) * scale);
  }
  return copy;
}
