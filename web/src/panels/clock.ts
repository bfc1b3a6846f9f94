// SPDX-License-Identifier: Apache-2.0

/// 14:03:59, of this browser's clock.
export function clockTime(unixSeconds: number): string {
  return new Date(unixSeconds * 1000).toLocaleTimeString("en-GB", { hour12: false });
}
