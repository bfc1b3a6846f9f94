// SPDX-License-Identifier: Apache-2.0
// The two logs of a story with a device: a row a tick of the controller, a row a step of the host.
import { readFileSync } from "node:fs";

export class Log {
  private constructor(
    private readonly columns: ReadonlyMap<string, number>,
    readonly rows: readonly (readonly string[])[],
  ) {}

  static read(file: string): Log {
    const [head, ...rows] = readFileSync(file, "utf8").split("\n").filter((line) => line !== "" && !line.startsWith("#"));
    const columns = new Map((head ?? "").split(",").map((name, i) => [name, i] as const));
    return new Log(columns, rows.map((row) => row.split(",")));
  }

  text(row: number, column: string): string {
    const at = this.columns.get(column);
    if (at === undefined) throw new Error(`there is no column ${column}; there are ${[...this.columns.keys()].join(" ")}`);
    return this.rows[row]?.[at] ?? "";
  }

  number(row: number, column: string): number {
    return Number(this.text(row, column));
  }

  /// The first row from `from` on that `is`; the number of rows if there is none.
  first(from: number, is: (row: number) => boolean): number {
    let row = from;
    while (row < this.rows.length && !is(row)) ++row;
    return row;
  }
}
