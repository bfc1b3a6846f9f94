// SPDX-License-Identifier: Apache-2.0
// Makes the pictures of the scenes' cards, web/src/pictures/NAME.webp, by the page itself: the hand at the object, without arrows. Not a test.
// npx vite-node tests/browser/scene_pictures.ts [NAME ...]; the page must have been built.
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { strings } from "../../src/strings";
import { CockpitPage } from "./support/cockpit_page";
import { addressOf, projectFolder, runStation, slowMotion } from "./support/program";
import { until } from "./support/until";
import { launch } from "./view3d_page/browser";

const [kWidth, kHeight] = [256, 192]; // of a card's picture
const kScreen = { width: 1024, height: 900 };
const kQuality = 0.82; // of WebP
const kHolding = 60; // ticks
const kCloser = 1.12; // than the view's own preset

/// The PNG in the size of a card, its middle part, as WebP.
function scaled(page: Page, png: Buffer): Promise<string> {
  return page.evaluate(
    async ({ data, width, height, quality, closer }) => {
      const image = new Image();
      image.src = data;
      await image.decode();
      const scale = closer * Math.max(width / image.width, height / image.height);
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [width, height];
      const context = canvas.getContext("2d")!;
      context.imageSmoothingQuality = "high";
      context.drawImage(image, (width - scale * image.width) / 2, (height - scale * image.height) / 2, scale * image.width, scale * image.height);
      return canvas.toDataURL("image/webp", quality);
    },
    { data: `data:image/png;base64,${png.toString("base64")}`, width: kWidth, height: kHeight, quality: kQuality, closer: kCloser },
  );
}

async function shoot(scene: string, folder: string): Promise<number> {
  const work = mkdtempSync(join(tmpdir(), "phalanx-scene-picture-"));
  const station = runStation(work, join(work, "clock"), slowMotion.alone, [scene, "--port", "0", "--record", "off"]);
  const browser = await launch();
  try {
    const { url } = await addressOf(station);
    const page = await browser.newPage({ viewport: kScreen, colorScheme: "dark" });
    const cockpit = new CockpitPage(page);
    await cockpit.go(url);
    await cockpit.untilRunning();
    await cockpit.untilTouching();
    await page.getByText(strings.view.partsMenu, { exact: true }).click();
    for (const part of ["ghost", "arrows"] as const) await cockpit.switch(strings.view.parts[part]).click();
    await page.getByText(strings.view.partsMenu, { exact: true }).click();
    await page.evaluate(() => document.querySelector<HTMLElement>(".view-key")!.style.setProperty("visibility", "hidden"));
    // Without torque no segment is tinted. The patient goes on squeezing.
    await cockpit.stopButton.click();
    await cockpit.untilStopped();
    await until("a hand that holds", () => cockpit.stream.ticks.slice(-kHolding).every((tick) => tick.contact.some((contact) => contact.touching)), () => cockpit.brief());
    const picture = await scaled(page, await page.locator(".view-host").screenshot());
    const bytes = Buffer.from(picture.split(",")[1]!, "base64");
    writeFileSync(join(folder, `${scene}.webp`), bytes);
    return bytes.length;
  } finally {
    await browser.close();
    await station.end();
  }
}

const folder = join(projectFolder, "web/src/pictures");
mkdirSync(folder, { recursive: true });
const exercises = readdirSync(join(projectFolder, "scenes"))
  .filter((file) => file.endsWith(".toml") && !/\npurpose = /.test(readFileSync(join(projectFolder, "scenes", file), "utf8")))
  .map((file) => file.replace(".toml", ""))
  .filter((name) => name !== "wave"); // touches nothing
const named = process.argv.slice(2);
for (const scene of named.length > 0 ? named : exercises) console.log(`${scene}: ${await shoot(scene, folder)} bytes`);
