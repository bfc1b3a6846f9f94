// SPDX-License-Identifier: Apache-2.0
// The patient's screen in every state, without a station: what a person must be able to read, tap and stop is there.
import type { Server } from "node:http";
import { chromium, type Browser, type Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, inject, it } from "vitest";
import { Feel_Kind } from "../../src/gen/phalanx/cockpit_pb";
import { FlashGuard, kMostFlashes, luminance } from "../../src/patient/flash_guard";
import { de } from "../../src/strings/patient_de";
import { en } from "../../src/strings/patient_en";
import { serveSite } from "./fake_host";
import { PatientHost, feeling, opposing, pressing, ranging, squeezing, tracking, type ExerciseInit } from "./patient_host";
import { screenStates } from "./patient_stage";
import { allRules, bringAxe, violations } from "./support/axe";
import { shoot } from "./support/pictures";
import { until } from "./support/until";

const kTap = 88; // [pixels]
const kScale = process.env["PHALANX_LARGE_PICTURES"] === undefined ? 0.5 : 1; // of the pixels that are drawn: a quarter of them takes a quarter of the time
const sizes = { phone: { width: 390, height: 844 }, laptop: { width: 1280, height: 800 }, projector: { width: 1920, height: 1080 } };
type Size = keyof typeof sizes;
const kEach: Readonly<Record<Size, number>> = { phone: 1, laptop: 3, projector: 9 }; // every so many states: words are clipped on the smallest first
let browser: Browser;
let site: { server: Server; url: string };

beforeAll(async () => {
  browser = await chromium.connect(inject("browser"));
  site = await serveSite();
});
afterAll(async () => {
  site.server.close();
  await browser.close();
});

/// A page with its host, which are closed after `use`.
async function opened(viewport: { width: number; height: number }, query: string, use: (page: Page, host: PatientHost) => Promise<void>, host = new PatientHost()): Promise<void> {
  const context = await browser.newContext({ viewport, deviceScaleFactor: kScale });
  const page = await context.newPage();
  try {
    await host.attach(page);
    await page.goto(`${site.url}patient.html?${query}`);
    await page.locator(".patient").waitFor();
    await use(page, host);
  } finally {
    host.end();
    await context.close();
  }
}

/// What is too small to be tapped, clipped, or covered by another part that can be tapped.
const faults = (page: Page, tap: number) =>
  page.evaluate((least) => {
    const found: string[] = [];
    const seen = (element: Element) => element.getClientRects().length > 0;
    const controls = [...document.querySelectorAll<HTMLElement>("button, input")].filter(seen);
    for (const one of controls) {
      const { width, height } = one.getBoundingClientRect();
      if (width < least || height < least) found.push(`${one.className} is ${width.toFixed(0)} x ${height.toFixed(0)}`);
    }
    for (const one of document.querySelectorAll<HTMLElement>(".bar-button")) {
      const { left, right, top, bottom } = one.getBoundingClientRect();
      if (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight) found.push(`${one.className} is outside of the page`);
      if (!one.contains(document.elementFromPoint((left + right) / 2, (top + bottom) / 2))) found.push(`${one.className} is covered`);
    }
    for (const one of document.querySelectorAll<HTMLElement>("h1, h2, p, span, button, li, label")) {
      if (seen(one) && getComputedStyle(one).display !== "inline" && one.scrollWidth > one.clientWidth + 1) found.push(`${one.tagName} ${one.textContent} is clipped`);
    }
    return found;
  }, tap);

describe.each(Object.keys(sizes) as Size[])("on a %s", (name) => {
  const viewport = sizes[name];
  it.each(screenStates.filter((_, number) => number % kEach[name] === 0))("the state $name has no violation of accessibility, is whole, and keeps STOP in reach", async ({ name: state, set, query, press, then, shown }) => {
    const language = name === "phone" ? "de" : "en";
    const host = new PatientHost();
    host.accounts = state.startsWith("sign_in");
    await opened(viewport, `lang=${language}&speech=0&${query ?? ""}`, async (page) => {
      await until("the station's welcome", () => host.asked.some(({ what }) => what.case === "hello"));
      const screen = page.locator(".patient");
      set(host);
      if (state === "expired") await page.getByRole("heading", { name: (language === "de" ? de : en).screen.expired }).waitFor();
      if (shown && press) await page.locator(".patient:not([data-screen='greet'])").waitFor();
      if (press) await page.locator(press).click({ noWaitAfter: true });
      if (then) await until("the press", () => host.asked.some(({ what }) => what.case === "feel" || what.case === "stop"));
      then?.(host);
      if (shown) await page.locator(`.patient[data-screen="${shown}"]`).waitFor();
      await until("the state", async () => (state === "greet" ? (await screen.getAttribute("data-screen")) === "greet" : (await page.locator("h1, .sign-in h2").first().innerText()) !== ""));
      await page.waitForFunction(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true)))));
      await bringAxe(page);
      expect(await violations(page, allRules), state).toEqual([]);
      expect(await faults(page, kTap), state).toEqual([]);
      await shoot(page, `patient_${state}_${name}`);
    }, host);
  });
});

describe("the patient's screen", () => {
  it("sends a break and a rating by one tap each, and STOP by Space", async () => {
    await opened(sizes.laptop, "lang=en&speech=0", async (page, host) => {
      host.play((t) => tracking(t));
      await page.locator('.patient[data-screen="play"]').waitFor();
      await page.locator(".bar-pain").click({ noWaitAfter: true });
      await page.locator('.faces[data-hears="true"]').waitFor();
      await page.locator('.face-button[data-value="4"]').click({ noWaitAfter: true });
      await until("the rating", () => host.asked.some(({ what }) => what.case === "feel" && what.value.kind === Feel_Kind.PAIN && what.value.value === 4));
      expect(host.asked.filter(({ what }) => what.case === "feel").map(({ what }) => (what.case === "feel" ? what.value.kind : -1))).toEqual([Feel_Kind.PAUSE, Feel_Kind.PAIN]);
      await page.keyboard.press("Space");
      await until("STOP", () => host.asked.some(({ what }) => what.case === "stop"));
      const sent = new Set(host.asked.map(({ what }) => what.case));
      expect([...sent].filter((one) => !["hello", "seen", "feel", "stop"].includes(String(one)))).toEqual([]);
    });
  });

  it("asks for a sign-in where the station refuses what it sends", async () => {
    await opened(sizes.laptop, "lang=en&speech=0", async (page, host) => {
      host.refuse = "sign in at this screen first";
      await page.locator(".bar-pause").click({ noWaitAfter: true });
      await page.getByRole("heading", { name: en.signIn.title }).waitFor();
      await until("STOP in place of the refused break", () => host.asked.some(({ what }) => what.case === "stop"));
    });
  });

  it("changes its language and comes back with the same options", async () => {
    await opened(sizes.laptop, "lang=en&speech=0&numbers=1", async (page) => {
      await page.locator(".menu-opener").click({ noWaitAfter: true });
      await page.locator('.choice[data-value="de"]').click({ noWaitAfter: true });
      await page.locator('html[lang="de-DE"]').waitFor({ state: "attached" });
      expect(new URL(page.url()).searchParams.get("numbers")).toBe("1");
    });
  });

  const games: readonly (readonly [string, (t: number) => ExerciseInit])[] = [
    ["force tracking", (t) => tracking(t)], ["press and hold", pressing], ["squeeze and release", squeezing], ["range of motion", ranging], ["opposition", opposing], ["feel and find", feeling],
  ];
  it.each(games)("flashes at most three times a second in the game of %s", async (_, script) => {
    await opened({ width: 400, height: 300 }, "lang=en&speech=0&sound=0", async (page, host) => {
      host.play(script);
      await page.locator('.patient[data-screen="play"]').waitFor();
      const frames = await page.evaluate(
        (count) =>
          new Promise<{ time: number; cells: number[] }[]>((done) => {
            const stage = document.querySelector<HTMLCanvasElement>("canvas.stage")!;
            const pen = Object.assign(document.createElement("canvas"), { width: 16, height: 12 }).getContext("2d", { willReadFrequently: true })!;
            const taken: { time: number; cells: number[] }[] = [];
            const take = (now: number) => {
              pen.drawImage(stage, 0, 0, 16, 12); // in the frame in which it was drawn
              taken.push({ time: now / 1000, cells: [...pen.getImageData(0, 0, 16, 12).data] });
              if (taken.length < count) requestAnimationFrame(take);
              else done(taken);
            };
            requestAnimationFrame(take);
          }),
        90,
      );
      const guard = new FlashGuard();
      for (const { time, cells } of frames) {
        guard.take(time, Array.from({ length: cells.length / 4 }, (__, i) => luminance(cells[4 * i]!, cells[4 * i + 1]!, cells[4 * i + 2]!)));
      }
      const brightest = Math.max(...frames.at(-1)!.cells);
      expect(brightest, "a picture was drawn").toBeGreaterThan(30);
      expect(guard.flashes).toBeLessThanOrEqual(kMostFlashes);
    });
  });
});
