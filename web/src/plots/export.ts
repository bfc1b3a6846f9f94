// SPDX-License-Identifier: Apache-2.0
// Export of a plot as a file.
import { channels } from "../state/channels";
import { toCsv } from "../state/csv";
import type { Shown } from "../state/shown";
import { kHistorySeconds } from "../state/store";
import { strings } from "../strings";
import { digitColours, themes, type ThemeName } from "../theme";
import { saveBlob } from "../panels/dom";
import { savedMark, savedName } from "../panels/saved_as";
import { columnName } from "./plot_kinds";

export function csvOf(shown: Shown): string {
  const { geometry, history } = shown;
  const columns = channels.map((channel) => ({
    name: columnName(channel, geometry?.segmentName ?? [], geometry?.jointName ?? []),
    unit: channel.unit,
  }));
  return toCsv(history, kHistorySeconds, columns);
}

export function saveCsv(shown: Shown): void {
  saveBlob(`${savedName(shown)}.csv`, new Blob([csvOf(shown)], { type: "text/csv" }));
}

/// One plot of the picture.
export interface Part {
  readonly title: string;
  readonly legend: string;
  readonly canvas: HTMLCanvasElement;
}

const kFont = "system-ui, sans-serif";
const kMargin = 8; // [px], as the others
const kKeyHeight = 30;
const kTitleLine = 22;
const kLegendLine = 40;
const kHead = 50; // above each plot
const kSwatch = 12;

/// The plots one under the other, with all that is needed to read them alone: which colour is which digit, each plot's title, and what
/// its lines mean. As wide as the widest of these.
/// @param digits  that are shown
/// @param mark  stands beside the digits; empty: nothing
export function drawPicture(parts: readonly Part[], digits: readonly boolean[], theme: ThemeName, mark = ""): HTMLCanvasElement | null {
  const out = document.createElement("canvas");
  const context = out.getContext("2d");
  if (!context || parts.length === 0) return null;
  const ratio = window.devicePixelRatio || 1;
  const px = (pixels: number) => Math.round(pixels * ratio);
  const fonts = { title: `600 ${px(14)}px ${kFont}`, small: `${px(12)}px ${kFont}` };
  const width = (font: string, text: string) => {
    context.font = font;
    return context.measureText(text).width;
  };
  const names = strings.digits.map((name, digit) => ({ name, colour: digitColours[theme][digit] ?? "" })).filter((_, digit) => digits[digit] ?? false);
  const keyWidth = (name: string) => px(kSwatch) + width(fonts.small, name) + 3 * px(kMargin);
  out.width = Math.ceil(
    Math.max(
      ...parts.map((part) => Math.max(part.canvas.width, 2 * px(kMargin) + Math.max(width(fonts.title, part.title), width(fonts.small, part.legend)))),
      px(kMargin) + names.reduce((sum, { name }) => sum + keyWidth(name), 0) + (mark ? width(fonts.title, mark) + px(kMargin) : 0),
    ),
  );
  out.height = parts.reduce((sum, part) => sum + part.canvas.height + px(kHead), px(kKeyHeight));

  const colours = themes[theme];
  const write = (font: string, colour: string, text: string, left: number, line: number) => {
    context.font = font;
    context.fillStyle = colour;
    context.fillText(text, left, line);
  };
  context.fillStyle = colours.panel;
  context.fillRect(0, 0, out.width, out.height);
  let left = px(kMargin);
  for (const { name, colour } of names) {
    context.fillStyle = colour;
    context.fillRect(left, px(kTitleLine - kSwatch + 1), px(kSwatch), px(kSwatch));
    write(fonts.small, colours.text, name, left + px(kSwatch) + px(kMargin), px(kTitleLine));
    left += keyWidth(name);
  }
  if (mark) write(fonts.title, colours.text, mark, left, px(kTitleLine));
  let top = px(kKeyHeight);
  for (const part of parts) {
    write(fonts.title, colours.text, part.title, px(kMargin), top + px(kTitleLine));
    write(fonts.small, colours.quiet, part.legend, px(kMargin), top + px(kLegendLine));
    context.drawImage(part.canvas, 0, top + px(kHead));
    top += part.canvas.height + px(kHead);
  }
  return out;
}

export function savePng(shown: Shown, parts: readonly Part[], digits: readonly boolean[], theme: ThemeName): void {
  drawPicture(parts, digits, theme, savedMark(shown))?.toBlob((blob) => blob && saveBlob(`${savedName(shown)}.png`, blob));
}
