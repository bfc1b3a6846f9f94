// SPDX-License-Identifier: Apache-2.0
// Times and sizes as text.
import { strings } from "../strings";

const two = (value: number) => String(value).padStart(2, "0");

/// 02:07.3, or 1:02:07.3.
export function durationText(seconds: number, decimals = 1): string {
  const scale = 10 ** decimals;
  const units = Math.max(0, Math.floor(seconds * scale + 1e-6));
  const whole = Math.floor(units / scale);
  const hours = Math.floor(whole / 3600);
  const clock = `${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
  const fraction = decimals > 0 ? `.${String(units % scale).padStart(decimals, "0")}` : "";
  return `${hours > 0 ? `${hours}:` : ""}${clock}${fraction}`;
}

/// 14:03:59, of this browser's clock.
export function clockTime(unixSeconds: number, decimals = 0): string {
  const fraction = decimals > 0 ? { fractionalSecondDigits: Math.min(3, decimals) as 1 | 2 | 3 } : {};
  const time = { hourCycle: "h23", hour: "2-digit", minute: "2-digit", second: "2-digit", ...fraction } as const;
  return new Date(unixSeconds * 1000).toLocaleTimeString(strings.figures, time);
}

/// 27 Nov 2026, 14:03, of this browser's clock.
export function momentText(unixSeconds: number): string {
  return new Date(unixSeconds * 1000).toLocaleString(strings.figures, { dateStyle: "medium", timeStyle: "short", hourCycle: "h23" });
}

export function sizeText(bytes: number): string {
  const megabytes = bytes / 1e6;
  const rounded = (value: number) => value.toLocaleString(strings.figures, { maximumFractionDigits: 1 });
  return megabytes < 1000 ? strings.device.megabytes(rounded(megabytes)) : strings.device.gigabytes(rounded(megabytes / 1000));
}
