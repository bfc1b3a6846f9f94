// SPDX-License-Identifier: Apache-2.0
// Makes the picture of the cockpit for the documents: the page of `./run` while the hand touches. Not a test.
// npx vite-node tests/browser/cockpit_picture.ts OUT.png; the page must have been built.
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { digitOfSegment } from "../../src/state/channels";
import { CockpitPage } from "./support/cockpit_page";
import { addressOf, runStation, slowMotion } from "./support/program";
import { until } from "./support/until";
import { launch } from "./view3d_page/browser";

const kScreen = { width: 1440, height: 900 };
const kFirm = 1.5; // [N]
const kCurves = 10; // that the plot shows [s]

const [out = "cockpit.png"] = process.argv.slice(2);
const work = mkdtempSync(join(tmpdir(), "phalanx-cockpit-picture-"));
const station = runStation(work, join(work, "clock"), slowMotion.alone, ["--port", "0", "--record", "off"]);
const browser = await launch();
try {
  const { url } = await addressOf(station);
  const page = await browser.newPage({ viewport: kScreen, colorScheme: "dark" });
  const cockpit = new CockpitPage(page);
  await cockpit.go(url);
  await cockpit.untilRunning();
  await cockpit.untilLater(kCurves);
  const holds = (digit: number) =>
    cockpit.stream.newest!.contact.some(({ segment, touching, force }) => digitOfSegment(segment) === digit && touching && force > kFirm);
  // The picture takes a second, so it is begun when a hold begins.
  await until("no firm hold", () => !holds(0) && !holds(1), () => cockpit.brief());
  await until("a firm thumb and index finger", () => holds(0) && holds(1), () => cockpit.brief());
  await page.screenshot({ path: resolve(out) });
} finally {
  await browser.close();
  await station.end();
}
