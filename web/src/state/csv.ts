// SPDX-License-Identifier: Apache-2.0
// The history as a file for spreadsheets.
import { strings } from "../strings";
import type { History } from "./history";

const field = (text: string) => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/// A channel of the history as a column.
export interface Column {
  readonly name: string;
  readonly unit: string; // empty: none
  readonly scale?: number; // factor from the stored to the written value
  readonly text?: (value: number) => string; // of a value that is a number of something named
}

function cell({ scale = 1, text }: Column, value: number): string {
  if (!Number.isFinite(value)) return "";
  return text ? field(text(value)) : String(Number((value * scale).toPrecision(7)));
}

/// The samples from one time to another. Times begin at the first row's; beside it stands the station's clock, as in its log. Values with
/// the digits that single precision carries; what is not known is empty.
/// @param columns  one for each channel of the history
export function toCsv(history: History, from: number, to: number, columns: readonly Column[]): string {
  const words = strings.plots;
  const times = [words.csvTime, words.csvClock].map((name) => words.csvHead(name, strings.units.second));
  const head = [...times, ...columns.map(({ name, unit }) => (unit ? words.csvHead(name, unit) : name))].map(field).join(",");
  const time = history.time();
  const values = columns.map((_, i) => history.channel(i));
  const first = history.firstFrom(from);
  const rows = [head];
  for (let i = first; i < time.length && time[i]! <= to; ++i) {
    const cells = [(time[i]! - time[first]!).toFixed(4), time[i]!.toFixed(4)];
    columns.forEach((column, channel) => cells.push(cell(column, values[channel]![i]!)));
    rows.push(cells.join(","));
  }
  return rows.join("\r\n") + "\r\n";
}
