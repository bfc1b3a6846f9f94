// SPDX-License-Identifier: Apache-2.0
import { chromium } from "playwright-core";
import type { Browser } from "playwright-core";

/// Debian's Chromium with WebGL drawn by the processor.
export function launch(): Promise<Browser> {
  return chromium.launch({
    executablePath: process.env["CHROMIUM"] ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-background-networking",
      "--disable-component-update", "--no-first-run", "--mute-audio",
    ],
  });
}
