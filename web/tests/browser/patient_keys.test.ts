// SPDX-License-Identifier: Apache-2.0
// The patient's screen without a mouse: sign-in, menu, an exercise with its ratings and a break, and STOP from everywhere. Focus is moved with
// Tab alone, and must be seen wherever it is.
import type { Server } from "node:http";
import { chromium, type Browser, type Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, inject, it } from "vitest";
import { Feel_Kind, type ToHost } from "../../src/gen/phalanx/cockpit_pb";
import { en } from "../../src/strings/patient_en";
import { serveSite } from "./fake_host";
import { answering, asking, ended, PatientHost, tracking } from "./patient_host";
import { shoot } from "./support/pictures";
import { small } from "./support/stage";
import { paintNothing, slowScreen } from "./support/slow_screen";
import { until } from "./support/until";

const kMostTabs = 30;
let browser: Browser;
let site: { server: Server; url: string };
let page: Page;
const host = new PatientHost();

const keys = () => page.keyboard;
const screen = (name: string) => page.locator(`.patient[data-screen="${name}"]`).waitFor();
const stops = () => host.asked.filter(({ what }) => what.case === "stop").length;
const felt = () => host.asked.flatMap(({ what }: ToHost) => (what.case === "feel" ? [[what.value.kind, what.value.value]] : []));

interface Focused {
  readonly selector: string; // class and value of what has the focus
  readonly seen: boolean; // it is marked, wholly on the page, and not covered
}

const focused = (): Promise<Focused> =>
  page.evaluate(() => {
    const element = document.activeElement as HTMLElement;
    const { outlineStyle, outlineWidth } = getComputedStyle(element);
    const { left, right, top, bottom } = element.getBoundingClientRect();
    const marked = outlineStyle !== "none" && parseFloat(outlineWidth) >= 3;
    const inside = left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
    const covered = !element.contains(document.elementFromPoint((left + right) / 2, (top + bottom) / 2));
    return { selector: `${element.tagName.toLowerCase()}.${element.className}#${element.id}[${element.dataset["value"] ?? element.textContent}]`, seen: marked && inside && !covered };
  });

/// Presses Tab until what has the focus has this in its selector. Each stop on the way must be seen.
async function tabTo(wanted: string): Promise<void> {
  const passed: string[] = [];
  for (let i = 0; i < kMostTabs; ++i) {
    await keys().press("Tab");
    const { selector, seen } = await focused();
    passed.push(selector);
    if (!selector.startsWith("body")) expect(seen, `the focus on ${selector} is seen`).toBe(true);
    if (selector.includes(wanted)) return;
  }
  throw new Error(`Tab never came to ${wanted}; it came to ${passed.join("; ")}`);
}

/// STOP by a key, wherever the focus is.
async function stopBy(key: string): Promise<void> {
  const before = stops();
  await keys().press(key);
  await until(`STOP by ${key}`, () => stops() > before);
}

beforeAll(async () => {
  browser = await chromium.connect(inject("browser"));
  site = await serveSite();
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, deviceScaleFactor: 0.5, reducedMotion: "reduce" });
  await context.addInitScript(slowScreen, small.hertz!);
  await context.addInitScript(paintNothing);
  page = await context.newPage();
  host.accounts = true;
  await host.attach(page);
  await page.route("**/people/sign_in", (route) => route.fulfill({ status: 200, contentType: "application/json", body: JSON.stringify({ session: "s", account: "screen", role: "patient_screen", idle_s: 600 }) }));
  await page.route("**/people/alive", (route) => route.fulfill({ status: 200, contentType: "application/json", body: "{}" }));
  await page.goto(`${site.url}patient.html?lang=en&speech=0&sound=0`);
  await screen("sign_in");
});
afterAll(async () => {
  host.end();
  site.server.close();
  await browser.close();
});

describe("the patient's screen by keys alone", () => {
  it("signs in", async () => {
    await tabTo("#screen-account");
    await keys().type("screen one");
    await tabTo("#screen-password");
    await keys().type("a long password");
    expect(stops(), "blanks that are typed stop nothing").toBe(0);
    await stopBy("Escape");
    await keys().press("Enter");
    await screen("greet");
  });

  it("opens the menu, changes an option and comes back", async () => {
    host.idle();
    await tabTo("menu-opener");
    await keys().press("Enter");
    expect((await focused()).selector).toContain("menu-close");
    await tabTo(en.menu.numbers);
    await shoot(page, "patient_keys_menu");
    await keys().press("Enter");
    await page.getByRole("switch", { name: en.menu.numbers, checked: true }).waitFor();
    await stopBy("Space");
    await keys().press("Enter"); // Space has pressed nothing
    await page.getByRole("switch", { name: en.menu.numbers, checked: false }).waitFor();
    await tabTo("menu-close");
    await keys().press("Enter");
    expect((await focused()).selector).toContain("menu-opener");
  });

  it("stops by Enter on STOP, by Space and by Esc in a game", async () => {
    host.play((t) => tracking(t));
    await screen("play");
    for (const key of ["Space", "Escape"]) {
      await stopBy(key);
      await screen("break");
      host.goOn((t) => tracking(t));
      await screen("play");
    }
    await tabTo("bar-stop");
    await shoot(page, "patient_keys_stop");
    await stopBy("Enter");
    host.goOn((t) => tracking(t));
    await screen("play");
  });

  it("takes a break, and goes on without a lost focus", async () => {
    await tabTo("bar-pause");
    await keys().press("Enter");
    await screen("break");
    expect(felt()).toEqual([[Feel_Kind.PAUSE, 0]]);
    host.goOn((t) => tracking(t));
    await screen("play");
    expect((await focused()).selector).toContain("bar-pause");
  });

  it("says how much it hurts, by Tab to a face", async () => {
    await tabTo("bar-pain");
    await keys().press("Enter");
    await page.locator('.faces[data-hears="true"]').waitFor();
    expect((await focused()).selector, "a key that is held down answers nothing").toContain("rating-title");
    await tabTo("face-button#[4]");
    await shoot(page, "patient_keys_face");
    await keys().press("Enter");
    await until("the rating", () => felt().some(([kind, value]) => kind === Feel_Kind.PAIN && value === 4));
    expect((await focused()).selector).toContain("bar-pain");
    await tabTo("bar-tired");
    await keys().press("Enter");
    await tabTo("rating-back");
    await keys().press("Enter");
    expect((await focused()).selector).toContain("bar-tired");
  });

  it("answers the station's question, and has nothing to press where the therapist enters the answer", async () => {
    host.show(asking(Feel_Kind.TIRED));
    await screen("rating");
    await page.locator('.faces[data-hears="true"]').waitFor();
    await tabTo("face-button#[6]");
    await keys().press("Enter");
    await until("the rating", () => felt().some(([kind, value]) => kind === Feel_Kind.TIRED && value === 6));
    host.show(answering);
    await screen("answer");
    for (let i = 0; i < 6; ++i) {
      await keys().press("Tab");
      expect((await focused()).selector).toMatch(/bar-|menu-opener|body/);
    }
    await stopBy("Space");
    host.show(ended);
    await screen("done");
  });
});
