// SPDX-License-Identifier: Apache-2.0
// Views side by side: which, and how broad. The first has most of the room.
import type { CameraPreset, Pane } from "./hand_view";

export const kMostViews = 3;
const kNarrowest = [0, 560, 900]; // widths for one, two and three views [pixels of the style sheet]
const kShares: readonly (readonly number[])[] = [[1], [0.6, 0.4], [0.5, 0.25, 0.25]];
const kOthers: readonly CameraPreset[] = ["palm", "contact", "home"];

/// How many of the wished views have room.
export function viewsWithRoom(wished: number, width: number): number {
  const most = Math.min(kMostViews, Math.max(1, Math.round(wished)));
  return kNarrowest.filter((least, i) => i < most && width >= least).length || 1;
}

/// @param main  preset of the first view; null: it was moved by hand
export function panesFor(count: number, main: CameraPreset | null): Pane[] {
  const others = kOthers.filter((preset) => preset !== main);
  let left = 0;
  return kShares[count - 1]!.map((width, i) => {
    const pane = { preset: i === 0 ? main : others[i - 1]!, left, width };
    left += width;
    return pane;
  });
}
