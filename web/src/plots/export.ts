// SPDX-License-Identifier: Apache-2.0
// What is plotted, as files.
import { channels } from "../state/channels";
import { toCsv } from "../state/csv";
import type { Store } from "../state/store";
import { themes, type ThemeName } from "../theme";
import { saveBlob, stamp } from "../panels/dom";
import { columnName } from "./plot_kinds";

export function csvOf(store: Store): string {
  const { geometry, history } = store;
  const columns = channels.map((channel) => ({
    name: columnName(channel, geometry?.segmentName ?? [], geometry?.jointName ?? []),
    unit: channel.unit,
  }));
  return toCsv(history, columns);
}

export function saveCsv(store: Store): void {
  saveBlob(`phalanx-${stamp()}.csv`, new Blob([csvOf(store)], { type: "text/csv" }));
}

/// The plots one under the other, each with its title and what its lines mean.
export function savePng(parts: readonly { readonly title: string; readonly legend: string; readonly canvas: HTMLCanvasElement }[], theme: ThemeName): void {
  const first = parts[0];
  if (!first) return;
  const ratio = window.devicePixelRatio || 1;
  const head = Math.round(34 * ratio);
  const out = document.createElement("canvas");
  out.width = Math.max(...parts.map((part) => part.canvas.width));
  out.height = parts.reduce((sum, part) => sum + part.canvas.height + head, 0);
  const context = out.getContext("2d");
  if (!context) return;
  const colours = themes[theme];
  context.fillStyle = colours.panel;
  context.fillRect(0, 0, out.width, out.height);
  let top = 0;
  for (const part of parts) {
    context.fillStyle = colours.text;
    context.font = `600 ${14 * ratio}px system-ui, sans-serif`;
    context.fillText(part.title, 8 * ratio, top + 22 * ratio);
    const width = context.measureText(part.title).width;
    context.fillStyle = colours.quiet;
    context.font = `${11 * ratio}px system-ui, sans-serif`;
    context.fillText(part.legend, width + 24 * ratio, top + 22 * ratio);
    context.drawImage(part.canvas, 0, top + head);
    top += part.canvas.height + head;
  }
  out.toBlob((blob) => blob && saveBlob(`phalanx-${stamp()}.png`, blob));
}
