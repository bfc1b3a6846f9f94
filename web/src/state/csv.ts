// SPDX-License-Identifier: Apache-2.0
// The history as a file for spreadsheets.
import { strings } from "../strings";
import type { History } from "./history";

const field = (text: string) => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/// The last `seconds`. Times begin at the first row's; beside it stands the station's clock, as in its log. Values with the digits that
/// single precision carries; what is not known is empty.
/// @param columns  name and unit of each channel of the history
export function toCsv(history: History, seconds: number, columns: readonly { readonly name: string; readonly unit: string }[]): string {
  const words = strings.plots;
  const times = [words.csvTime, words.csvClock].map((name) => words.csvHead(name, strings.units.second));
  const head = [...times, ...columns.map((column) => words.csvHead(column.name, column.unit))].map(field).join(",");
  const time = history.time();
  const values = columns.map((_, i) => history.channel(i));
  const first = time.findIndex((at) => at >= history.end - seconds);
  const rows = [head];
  for (let i = Math.max(first, 0); i < time.length; ++i) {
    const cells = [(time[i]! - time[first]!).toFixed(4), time[i]!.toFixed(4)];
    for (const channel of values) {
      const value = channel[i]!;
      cells.push(Number.isFinite(value) ? String(Number(value.toPrecision(7))) : "");
    }
    rows.push(cells.join(","));
  }
  return rows.join("\r\n") + "\r\n";
}
