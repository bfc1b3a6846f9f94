// SPDX-License-Identifier: Apache-2.0
import { strings } from "../strings";

/// 14:03:59, of this browser's clock.
export function clockTime(unixSeconds: number, decimals = 0): string {
  const fraction = decimals > 0 ? { fractionalSecondDigits: Math.min(3, decimals) as 1 | 2 | 3 } : {};
  return new Date(unixSeconds * 1000).toLocaleTimeString(strings.figures, { hourCycle: "h23", hour: "2-digit", minute: "2-digit", second: "2-digit", ...fraction });
}
