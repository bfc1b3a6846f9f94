// SPDX-License-Identifier: Apache-2.0
// How soon a page is painted, how soon the hand is drawn, and how soon a change of the stiffness is felt and seen, with a station in real
// time. Not a test: prints what it measured here and now. The frames of the view alone: view3d_page/measure.ts.
// npx vite-node tests/browser/page_delays.ts; the page must have been built.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { strings } from "../../src/strings";
import { CockpitPage } from "./support/cockpit_page";
import { addressOf, runStation } from "./support/program";
import { pause } from "./support/until";
import { launch } from "./view3d_page/browser";

declare global {
  interface Window {
    handDrawnAt: number | undefined; // since the begin of the navigation [ms]
  }
}

const kRealTime = 1;
const kLoads = 10;
const kChanges = 50;
const kPlaces = [350, 450]; // of the slider, of 1000
const kBetweenMs = 500; // a change is complete after 0.2 s
const kScreen = { viewport: { width: 1440, height: 900 } };

function printed(what: string, milliseconds: readonly number[]): void {
  const sorted = [...milliseconds].sort((a, b) => a - b);
  const quantile = (share: number) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))]!.toFixed(0);
  console.log(`${what}: p50 ${quantile(0.5)} ms, p95 ${quantile(0.95)} ms, of ${sorted.length}`);
}

/// Runs in the page, before anything of its own.
function noteFirstHand(): void {
  const look = (): void => {
    if ((window.phalanx?.view()?.shown.length ?? 0) > 0) window.handDrawnAt = performance.now();
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

async function measureLoads(browser: Browser, url: string): Promise<void> {
  const [paints, hands]: [number[], number[]] = [[], []];
  for (let i = 0; i < kLoads; ++i) {
    const context = await browser.newContext(kScreen); // without anything of the load before
    const page = await context.newPage();
    await page.addInitScript(noteFirstHand);
    await page.goto(url);
    await page.waitForFunction(() => window.handDrawnAt !== undefined, undefined, { timeout: 60_000 });
    hands.push((await page.evaluate(() => window.handDrawnAt))!);
    paints.push((await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime)) ?? NaN);
    await context.close();
  }
  printed("first contentful paint", paints);
  printed("the hand is drawn", hands);
}

interface Delay {
  readonly felt: number; // a step with another stiffness has come [ms]
  readonly seen: number; // it is drawn [ms]
}

/// Runs in the page. Moves the slider as a drag does, and waits for the first step whose wall has another stiffness.
function delayOf(slider: HTMLInputElement, place: number): Promise<Delay> {
  return new Promise((done) => {
    const before = window.phalanx.tick()!.stiffness;
    const began = performance.now();
    slider.value = String(place);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    const seen = (number: bigint, felt: number): void => {
      if (window.phalanx.view()!.tick < number) return void requestAnimationFrame(() => seen(number, felt));
      slider.dispatchEvent(new Event("change", { bubbles: true }));
      done({ felt, seen: performance.now() - began });
    };
    const felt = (): void => {
      const { stiffness, tick } = window.phalanx.tick()!;
      if (stiffness === before) return void setTimeout(felt);
      seen(tick, performance.now() - began);
    };
    felt();
  });
}

async function measureChanges(browser: Browser, url: string): Promise<void> {
  const page = await browser.newPage(kScreen);
  const cockpit = new CockpitPage(page);
  await cockpit.go(url);
  await cockpit.untilRunning();
  const slider = cockpit.slider(strings.force.stiffness);
  const delays: Delay[] = [];
  for (let i = 0; i < kChanges; ++i) {
    await pause(kBetweenMs);
    await cockpit.untilTouching();
    delays.push(await slider.evaluate(delayOf, kPlaces[i % kPlaces.length]!));
  }
  printed("from the slider to a step with the changed force", delays.map(({ felt }) => felt));
  printed("from the slider to its picture", delays.map(({ seen }) => seen));
  const { quality, framesPerSecond } = (await cockpit.probe())!;
  console.log(`the view draws ${framesPerSecond} frames a second at quality ${quality}`);
}

const folder = mkdtempSync(join(tmpdir(), "phalanx-page-delays-"));
const station = runStation(folder, join(folder, "clock"), kRealTime, ["first_touch", "--port", "0", "--record", "off"]);
const browser = await launch();
try {
  const { url } = await addressOf(station);
  await measureLoads(browser, url);
  await measureChanges(browser, url);
} finally {
  await browser.close();
  await station.end();
  rmSync(folder, { recursive: true, force: true });
}
