// SPDX-License-Identifier: Apache-2.0
// demo.html, built by its one command and opened from disk: both hands and forces are drawn, the scrubber moves, nothing is asked for.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium, type Browser, type Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, inject, it } from "vitest";
import { strings } from "../../src/strings";
import { kHangMs, until } from "./support/until";
import { projectFolder } from "./support/program";

const kMostBytes = 3_000_000;
const kSeen = 1e-3; // the hands are this far apart somewhere [m]
const words = strings.replay;
const folder = mkdtempSync(join(tmpdir(), "phalanx-demo-"));
const file = join(folder, "demo.html");
const address = pathToFileURL(file).href;
let browser: Browser;
let page: Page;
const asked: string[] = []; // addresses
const errors: string[] = [];

beforeAll(async () => {
  execFileSync(join(projectFolder, "scripts/demo"), [file], { stdio: "pipe" });
  browser = await chromium.connect(inject("browser"));
  const context = await browser.newContext({ viewport: { width: 1024, height: 768 }, deviceScaleFactor: 0.5, colorScheme: "dark", reducedMotion: "reduce" });
  page = await context.newPage();
  page.setDefaultTimeout(kHangMs);
  page.on("request", (request) => asked.push(request.url()));
  page.on("websocket", (socket) => asked.push(socket.url()));
  page.on("pageerror", (error) => errors.push(String(error.stack ?? error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await page.goto(address);
  await page.waitForFunction(() => window.phalanxDemo?.ready());
});

afterAll(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const position = () => page.evaluate(() => window.phalanxDemo.position());

/// The drawn hand of a moment.
async function at(time: number): Promise<NonNullable<ReturnType<Window["phalanxDemo"]["view"]>>> {
  await page.evaluate((wanted) => window.phalanxDemo.seek(wanted), time);
  await page.waitForFunction(() => window.phalanxDemo.settled());
  return (await page.evaluate(() => window.phalanxDemo.view()))!;
}

describe("demo.html", () => {
  it("is one small file that says how its recording was made", () => {
    expect(statSync(file).size).toBeLessThanOrEqual(kMostBytes);
    const text = readFileSync(file, "utf8");
    expect(text).toContain("./run run ");
    expect(text).toContain("default-src 'none'");
  });

  it("draws both hands and the forces", async () => {
    const length = await page.evaluate(() => window.phalanxDemo.length());
    let most = { apart: 0, arrows: 0, time: 0 };
    for (let time = 0; time < length; time += 0.5) {
      const { shown, ghost, arrows } = await at(time);
      expect(shown.length).toBe(16);
      expect(ghost.length).toBe(16);
      const apart = Math.max(...shown.map((point, i) => Math.hypot(...point.map((value, axis) => value - ghost[i]![axis]!))));
      if (apart > most.apart) most = { apart, arrows: arrows.length, time };
    }
    expect(most.apart).toBeGreaterThan(kSeen);
    expect(most.arrows).toBeGreaterThanOrEqual(3);
    // What is drawn is seen: without hand, measured hand or arrows the picture is another one.
    await at(most.time);
    const view = page.locator(".view-host");
    const picture = async () => (await view.screenshot()).toString("base64");
    const all = await picture();
    await page.getByText(strings.view.partsMenu, { exact: true }).click();
    for (const part of ["ghost", "arrows"] as const) {
      const control = page.getByRole("switch", { name: strings.view.parts[part] });
      await control.click();
      await page.getByText(strings.view.partsMenu, { exact: true }).click();
      await until(`a picture without ${part}`, async () => (await picture()) !== all);
      await page.getByText(strings.view.partsMenu, { exact: true }).click();
      await control.click();
    }
    await page.getByText(strings.view.partsMenu, { exact: true }).click();
  });

  it("is moved by scrubber and keys, and plays", async () => {
    const slider = page.getByRole("slider", { name: words.position });
    const box = (await slider.boundingBox())!;
    await slider.click({ position: { x: 0.75 * box.width, y: 40 } });
    const length = await page.evaluate(() => window.phalanxDemo.length());
    expect(await position()).toBeGreaterThan(0.7 * length);
    const { tick: late } = await at(await position());
    await slider.click({ position: { x: 0.25 * box.width, y: 40 } });
    expect(await position()).toBeLessThan(0.3 * length);
    expect((await at(await position())).tick).toBeLessThan(late);
    await page.keyboard.press("Home");
    expect(await position()).toBe(0);
    await page.keyboard.press("ArrowRight");
    expect(await position()).toBeCloseTo(1, 6);
    await page.keyboard.press("Space");
    await until("a second later", async () => (await position()) > 2);
    await page.keyboard.press("Space");
    const paused = await position();
    expect(await page.getByRole("button", { name: words.play, exact: true }).count()).toBe(1);
    expect(await position()).toBe(paused);
    await page.keyboard.press("End");
    expect(await position()).toBeCloseTo(length, 6);
  });

  it("fits a phone and a wide screen", async () => {
    for (const [width, height] of [[390, 844], [1024, 768], [1440, 900]] as const) {
      await page.setViewportSize({ width, height });
      expect(await page.evaluate(() => document.scrollingElement!.scrollWidth), `${width} px`).toBeLessThanOrEqual(width);
      for (const what of [page.locator(".view-host"), page.getByRole("slider", { name: words.position }), page.locator(".play"), page.getByRole("button", { name: strings.look.help })]) {
        const box = (await what.boundingBox())!;
        expect(box.x + box.width, `${width} px`).toBeLessThanOrEqual(width + 1);
        expect(box.height).toBeGreaterThan(20);
      }
    }
  });

  it("asks for nothing but itself", () => {
    expect(asked.filter((one) => one !== address && !/^(data|blob):/.test(one))).toEqual([]);
    expect(errors).toEqual([]);
  });
});
