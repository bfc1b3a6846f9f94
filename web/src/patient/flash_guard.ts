// SPDX-License-Identifier: Apache-2.0
// Counts flashes in frames as WCAG 2.2, 2.3.1, defines them: a pair of opposing changes of relative luminance by 10 % or more of the largest one,
// where the darker picture is below 0.80. Each cell of the frames counts by itself; a flash is one of an area that is a quarter or more of them.

export const kMostFlashes = 3; // in any second
const kChange = 0.1;
const kDark = 0.8;
const kWindow = 1; // [s]
const kArea = 0.25; // share of the cells that change in the same direction

/// Relative luminance of an sRGB colour, 0 .. 1.
export function luminance(red: number, green: number, blue: number): number {
  const linear = (value: number) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
  return 0.2126 * linear(red / 255) + 0.7152 * linear(green / 255) + 0.0722 * linear(blue / 255);
}

/// A cell: its extremes since its last large change, and the direction of that change.
interface Cell {
  low: number;
  high: number;
  rising: boolean | undefined;
}

export class FlashGuard {
  private cells: Cell[] = [];
  private readonly turns: { time: number; rising: boolean }[] = []; // of a large area
  private worst = 0;

  /// @param time  of the frame [s]  @param frame  luminance of each cell
  take(time: number, frame: readonly number[]): void {
    if (this.cells.length !== frame.length) this.cells = frame.map((value) => ({ low: value, high: value, rising: undefined }));
    let [up, down] = [0, 0];
    frame.forEach((value, i) => {
      const cell = this.cells[i]!;
      cell.low = Math.min(cell.low, value);
      cell.high = Math.max(cell.high, value);
      if (value - cell.low >= kChange && cell.low < kDark && cell.rising !== true) {
        Object.assign(cell, { rising: true, high: value, low: value });
        ++up;
      } else if (cell.high - value >= kChange && value < kDark && cell.rising !== false) {
        Object.assign(cell, { rising: false, high: value, low: value });
        ++down;
      }
    });
    for (const [count, rising] of [[up, true], [down, false]] as const) {
      if (count < kArea * frame.length) continue;
      if (this.turns.at(-1)?.rising !== rising) this.turns.push({ time, rising });
    }
    while (this.turns.length > 0 && time - this.turns[0]!.time > kWindow) this.turns.shift();
    this.worst = Math.max(this.worst, Math.floor(this.turns.length / 2));
  }

  /// Largest number of flashes within a second so far.
  get flashes(): number {
    return this.worst;
  }
}
