// SPDX-License-Identifier: Apache-2.0
// Pictures of the page in all its states, with a simulated station (FakeHost). Not a test: for looking at.
// npx vite-node tests/browser/page_pictures.ts FOLDER [NAME ...]; PHALANX_LANGUAGE=de: in German
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { english, languages } from "../../src/strings";
import { FakeHost, serveSite } from "./fake_host";
import { rememberLanguage } from "./support/page_language";
import { pageStates, type PageState } from "./support/page_states";
import { launch } from "./view3d_page/browser";

const language = languages.find(({ code }) => code === process.env["PHALANX_LANGUAGE"]) ?? english;
const wait = (ms: number) => new Promise<void>((done) => setTimeout(done, ms));

async function shoot(browser: Browser, url: string, folder: string, shot: PageState): Promise<void> {
  const [width, height] = shot.size ?? [1440, 900];
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: shot.light ? "light" : "dark" });
  await rememberLanguage(context, language);
  const page = await context.newPage();
  page.on("console", (message) => (message.type() === "error" || message.type() === "warning") && console.log(`  ${shot.name}: ${message.text()}`));
  page.on("pageerror", (error) => console.log(`  ${shot.name}: ${error.message}`));
  const host = new FakeHost();
  shot.before?.(host);
  await host.attach(page);
  await page.goto(url);
  await page.waitForFunction(() => (window.phalanx?.view()?.frames ?? 0) > 2, undefined, { timeout: 60_000 });
  await wait(3500);
  await shot.act?.(page, host, language.texts);
  await wait(700);
  await page.screenshot({ path: join(folder, `${shot.name}.png`), timeout: 60_000 });
  host.hush();
  await context.close();
}

const [folder = "/tmp/page", ...names] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const { server, url } = await serveSite();
const browser = await launch();
for (const shot of pageStates) {
  if (names.length > 0 && !names.includes(shot.name)) continue;
  console.log(shot.name);
  await shoot(browser, url, folder, shot).catch((error: unknown) => console.log(`  ${shot.name}: ${String(error)}`));
}
await browser.close();
server.close();
