// SPDX-License-Identifier: Apache-2.0
// Debian's Chromium with WebGL drawn by the processor. All else is drawn without OpenGL: the plots and the page itself through an OpenGL
// that is computed take five times the processor time.
import { join } from "node:path";
import type { LaunchOptions } from "playwright-core";
import { projectFolder } from "./program";

export const browserOptions: LaunchOptions = {
  executablePath: join(projectFolder, "web/tests/browser/support/chromium.sh"),
  args: [
    "--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-accelerated-2d-canvas", "--disable-gpu-rasterization",
    "--disable-gpu-compositing", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run", "--mute-audio",
  ],
};
