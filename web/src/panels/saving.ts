// SPDX-License-Identifier: Apache-2.0
// Files for the person: pictures and tables. Those of a recording have another name and a mark.
import type { Shown } from "../state/shown";
import { strings } from "../strings";
import { el } from "./dom";

/// Hands a file to the person.
export function saveFile(name: string, url: string): void {
  const link = el("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

export function saveBlob(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  saveFile(name, url);
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/// 20261122-010359, for names of files.
function stamp(date = new Date()): string {
  const two = (value: number) => String(value).padStart(2, "0");
  return (
    `${date.getFullYear()}${two(date.getMonth() + 1)}${two(date.getDate())}-` +
    `${two(date.getHours())}${two(date.getMinutes())}${two(date.getSeconds())}`
  );
}

/// The file's name without its ending. A recording's has the recorded moment, not today's date.
export function savedName({ recordedAt }: Shown): string {
  return recordedAt === undefined ? `phalanx-${stamp()}` : `phalanx-recording-${stamp(new Date(1000 * recordedAt))}`;
}

/// Words that are drawn into a saved picture; empty for a running station.
export function savedMark({ recordedAt }: Shown): string {
  return recordedAt === undefined ? "" : strings.replay.watermark;
}
