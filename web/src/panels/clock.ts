// SPDX-License-Identifier: Apache-2.0
import { strings } from "../strings";

/// 14:03:59, of this browser's clock.
export function clockTime(unixSeconds: number): string {
  return new Date(unixSeconds * 1000).toLocaleTimeString(strings.locale, { hourCycle: "h23" });
}
