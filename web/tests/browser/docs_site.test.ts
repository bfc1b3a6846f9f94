// SPDX-License-Identifier: Apache-2.0
// The built documents, opened from disk: search, menu, theme, and that they fit a phone, a tablet and a wide screen.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium, type Browser, type Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, inject, it } from "vitest";
import { kHangMs } from "./support/until";
import { projectFolder } from "./support/program";

const folder = mkdtempSync(join(tmpdir(), "phalanx-docs-"));
const pageOf = (name: string) => pathToFileURL(join(folder, "site", name)).href;
const kPages = ["index.html", "first-steps.html", "researchers.html", "clinic-engineers.html", "device-makers.html", "contributors.html", "cli.html", "glossary.html", "api/step/haptic_step.h.html"];
let browser: Browser;
let page: Page;
const asked: string[] = [];
const errors: string[] = [];

beforeAll(async () => {
  execFileSync(join(projectFolder, "scripts/docs_site"), [join(folder, "site"), "--no-demo"], { stdio: "pipe" });
  browser = await chromium.connect(inject("browser"));
  page = await (await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme: "light" })).newPage();
  page.setDefaultTimeout(kHangMs);
  page.on("request", (request) => asked.push(request.url()));
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
});

afterAll(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

describe("the documents from disk", () => {
  it("are searched by keyboard", async () => {
    await page.goto(pageOf("index.html"));
    await page.keyboard.press("/");
    await page.keyboard.type("virtual coupling");
    await page.getByRole("option").first().waitFor();
    expect(await page.getByRole("option").first().textContent()).toMatch(/virtual coupling/i);
    await page.keyboard.press("ArrowDown");
    expect(await page.getByRole("option").nth(1).getAttribute("aria-selected")).toBe("true");
    await page.getByRole("searchbox").or(page.getByRole("combobox")).fill("watchdog finger host gone");
    await page.getByRole("option", { name: /watchdog/i }).first().waitFor();
    await page.keyboard.press("Enter");
    await page.waitForURL(/device\.html#the-watchdog/);
    expect(await page.locator("#the-watchdog-what-holds-a-finger-when-the-host-is-gone").isVisible()).toBe(true);
    await page.keyboard.press("/");
    await page.keyboard.type("zzzqqq");
    await page.getByText("No page has all of these words.").waitFor();
  });

  it("are dark or light, as the reader chooses", async () => {
    const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.goto(pageOf("safety.html"));
    const light = await background();
    await page.locator("#theme").click();
    expect(await background()).not.toBe(light);
    await page.locator("#theme").click();
    expect(await background()).toBe(light);
  });

  it("fit 390, 1024 and 1440 pixels", async () => {
    for (const [width, height] of [[390, 844], [1024, 768], [1440, 900]] as const) {
      await page.setViewportSize({ width, height });
      for (const name of kPages) {
        await page.goto(pageOf(name));
        expect(await page.evaluate(() => document.scrollingElement!.scrollWidth), `${name} at ${width} px`).toBeLessThanOrEqual(width);
        expect(await page.locator("h1").first().isVisible()).toBe(true);
      }
    }
  });

  it("have a menu on a phone that leads from page to page", async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    await page.goto(pageOf("index.html"));
    await page.getByRole("button", { name: "Menu" }).click();
    await page.getByRole("navigation").getByRole("link", { name: "For device makers" }).click();
    await page.waitForURL(/device-makers\.html/);
  });

  it("ask for nothing but themselves", () => {
    expect(asked.filter((one) => !one.startsWith(pathToFileURL(join(folder, "site")).href) && !one.startsWith("data:"))).toEqual([]);
    expect(errors).toEqual([]);
  });
});
