// SPDX-License-Identifier: Apache-2.0
// Makes the animation of README from demo.html: Chromium shows one moment after the other, img2webp joins the pictures. Not a test.
// npx vite-node demo/animation.ts DEMO.html OUT.webp [FRAMES], with FRAMES: a folder that keeps the single pictures
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { browserOptions } from "../tests/browser/support/browser";

const kScreen = { width: 720, height: 450 };
const kFrom = 5.0; // [s] of the recording of the demo: the hand is open
const kTo = 9.8; // it is open again
const kRate = 15; // pictures a second
const kQuality = 80; // of WebP
const kMost = 1_500_000; // bytes

const [demo = "", out = "", keep] = process.argv.slice(2);
const folder = keep ?? mkdtempSync(join(tmpdir(), "phalanx-animation-"));
mkdirSync(folder, { recursive: true });
const browser = await chromium.launch(browserOptions);
try {
  const page = await browser.newPage({ viewport: kScreen, colorScheme: "dark", reducedMotion: "reduce" });
  await page.goto(pathToFileURL(resolve(demo)).href);
  await page.waitForFunction(() => window.phalanxDemo?.ready());
  // The view alone, over the whole picture.
  await page.addStyleTag({ content: ".header, .side, .replay-dock, .readouts, .plot-slot, .openings, .view-tools, .view-labels, .view-key, .watermark { display: none !important } #page, .content, .scene, .view-frame, .view-host { position: fixed !important; inset: 0 !important; width: auto !important; height: auto !important; padding: 0 !important; border-radius: 0 !important }" });
  await page.waitForTimeout(500); // the view has its new size
  const files: string[] = [];
  for (let i = 0; i < Math.round((kTo - kFrom) * kRate); ++i) {
    await page.evaluate((time) => window.phalanxDemo.seek(time), kFrom + i / kRate);
    await page.waitForFunction(() => window.phalanxDemo.settled());
    const file = join(folder, `${String(i).padStart(3, "0")}.png`);
    writeFileSync(file, await page.screenshot());
    files.push(file);
  }
  const each = files.flatMap((file) => ["-d", String(Math.round(1000 / kRate)), file]);
  execFileSync("img2webp", ["-loop", "0", "-lossy", "-q", String(kQuality), "-m", "4", ...each, "-o", resolve(out)], { stdio: "pipe" });
  const { size } = statSync(resolve(out));
  console.log(`${out}: ${files.length} pictures, ${size} bytes`);
  if (size > kMost) throw new Error(`more than ${kMost} bytes`);
} finally {
  await browser.close();
  if (keep === undefined) rmSync(folder, { recursive: true, force: true });
}
