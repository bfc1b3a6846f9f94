// SPDX-License-Identifier: Apache-2.0
// The history as a file for spreadsheets.
import { strings } from "../strings";
import type { History } from "./history";

const field = (text: string) => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/// Times begin at the first sample. Values with the digits that single precision carries; what is not known is empty.
/// @param columns  name and unit of each channel of the history
export function toCsv(history: History, columns: readonly { readonly name: string; readonly unit: string }[]): string {
  const words = strings.plots;
  const timeHead = words.csvHead(words.csvTime, strings.units.second);
  const head = [timeHead, ...columns.map((column) => words.csvHead(column.name, column.unit))].map(field).join(",");
  const time = history.time();
  const values = columns.map((_, i) => history.channel(i));
  const start = time[0] ?? 0;
  const rows = [head];
  for (let i = 0; i < time.length; ++i) {
    const cells = [(time[i]! - start).toFixed(4)];
    for (const channel of values) {
      const value = channel[i]!;
      cells.push(Number.isFinite(value) ? String(Number(value.toPrecision(7))) : "");
    }
    rows.push(cells.join(","));
  }
  return rows.join("\r\n") + "\r\n";
}
