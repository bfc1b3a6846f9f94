// SPDX-License-Identifier: Apache-2.0
// Every state of both pages, wide and narrow, dark and light: axe-core finds no violation.
import type { Server } from "node:http";
import { toBinary } from "@bufbuild/protobuf";
import { chromium, type Browser, type Page } from "playwright-core";
import { afterAll, beforeAll, describe, expect, inject, it } from "vitest";
import { GeometrySchema } from "../../src/gen/phalanx/geometry_pb";
import { bytesOf, event, gap, pose, setup } from "../unit/replay/made_recording";
import { english } from "../../src/strings";
import { FakeHost, serveSite } from "./fake_host";
import { allRules, bringAxe, colourRules, violations } from "./support/axe";
import { pageStates, type PageState } from "./support/page_states";
import { paintNothing, slowScreen } from "./support/slow_screen";
import { until } from "./support/until";
import { recording } from "./view3d_page/server";

const kWide = { width: 1440, height: 900 };
const kNarrow = { width: 390, height: 844 };
const kHertz = 10; // of the screen: axe-core gets the rest of the processor
const kRecorded = 240; // poses, 4 s
const kSelected = 6; // presses of a key

let browser: Browser;
let site: { readonly server: Server; readonly url: string };

beforeAll(async () => {
  site = await serveSite();
  browser = await chromium.connect(inject("browser"));
});
afterAll(async () => {
  await browser?.close();
  site?.server.close();
});

async function opened(): Promise<{ page: Page; errors: string[] }> {
  const context = await browser.newContext({ viewport: kWide, deviceScaleFactor: 0.5, colorScheme: "dark", reducedMotion: "reduce" });
  const page = await context.newPage();
  await page.addInitScript(paintNothing);
  await page.addInitScript(slowScreen, kHertz);
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  return { page, errors };
}

async function showTheme(page: Page, theme: "dark" | "light"): Promise<void> {
  await page.emulateMedia({ colorScheme: theme });
  await until(`the ${theme} theme`, () => page.evaluate((name) => document.documentElement.dataset["theme"] === name, theme));
}

async function expectNoViolation(page: Page, what: string): Promise<void> {
  await bringAxe(page);
  expect.soft(await violations(page, allRules), `${what}, wide, dark`).toEqual([]);
  await showTheme(page, "light");
  expect.soft(await violations(page, colourRules), `${what}, wide, light`).toEqual([]);
  await page.setViewportSize(kNarrow);
  expect.soft(await violations(page, colourRules), `${what}, narrow, light`).toEqual([]);
  await showTheme(page, "dark");
  expect.soft(await violations(page, allRules), `${what}, narrow, dark`).toEqual([]);
}

/// Shift with an arrow key selects a time in the first plot.
async function select(page: Page): Promise<void> {
  await page.focus(".plot");
  await page.keyboard.press("End");
  for (let i = 0; i < kSelected; ++i) await page.keyboard.press("Shift+ArrowLeft");
  await page.locator(".plot-selected").waitFor();
}

async function loseDevice(page: Page, host: FakeHost): Promise<void> {
  await page.click("[data-tab=device]");
  await host.cut();
  await page.locator(".lost-band").waitFor();
}

/// What is open beside the states whose layout is looked at.
const openStates: readonly PageState[] = [
  { name: "no_station", before: (host) => Object.assign(host.state, { stationGone: true, trouble: "The device did not open." }) },
  { name: "watch_only", before: (host) => (host.mayOperate = false) },
  { name: "all_scenes", act: async (page) => page.click(".section-scenes > button") },
  { name: "list_of_a_choice", act: async (page) => { await page.click("[data-tab=expert]"); await page.click(".row .choice:visible"); } },
  { name: "own_object", act: async (page) => page.click(".card-own") },
  { name: "parts_of_the_view", act: async (page) => page.click(".view-parts > summary") },
  { name: "plots_of_joints", act: async (page) => page.click(".plot-tools .segmented button:nth-child(3)") },
  { name: "selected_time", act: async (page) => select(page) },
  { name: "device_without_connection", act: (page, host) => loseDevice(page, host) },
];

describe.each([...pageStates.filter(({ again }) => !again), ...openStates])("the cockpit: $name", ({ name, before, act }) => {
  it("has no violation", async () => {
    const { page, errors } = await opened();
    const host = new FakeHost();
    before?.(host);
    await host.attach(page);
    await page.goto(site.url);
    await until("a picture", () => page.evaluate(() => (window.phalanx?.view()?.frames ?? 0) > 2));
    await page.locator(".plots").waitFor({ state: "attached" });
    await act?.(page, host, english.texts);
    await expectNoViolation(page, name);
    expect(errors).toEqual([]);
    host.hush();
    await page.context().close();
  });
});

// ---- the page of recordings

const kDevice = "Beihang exoskeleton";
const listed = { begin: 1_795_828_153, seconds: 4, events: 2, gaps: 1, bytes: 2_000_000, scene: "grasp_teapot", device: kDevice };
const list = {
  folder: "out/recordings",
  recordings: [
    { ...listed, name: "b.mcap", opens: false, state: "being written" },
    { ...listed, name: "a.mcap", opens: true, state: "whole" },
  ],
};

async function recordingFile(): Promise<{ name: string; mimeType: string; buffer: Buffer }> {
  const { geometry, ticks } = recording("grasp_teapot,skin");
  const seconds = (i: number) => 0.01 + i / 60;
  const bytes = await bytesOf(
    [
      { topic: "/geometry", time: 0, data: toBinary(GeometrySchema, geometry) },
      setup(0.001, { deviceName: kDevice }),
      ...ticks.slice(0, kRecorded).map((tick, i) => pose(seconds(i), { ...tick, tick: BigInt(i + 1), time: 1000 + seconds(i) })),
      event(seconds(kRecorded), "marker", "stimulus 1"),
      event(seconds(kRecorded), "fault", "sensor_jump: a sensor's angle jumped."),
      gap(seconds(kRecorded), BigInt(kRecorded + 1), BigInt(kRecorded + 9), "late"),
    ],
    { chunkSize: 1 << 20 },
  );
  return { name: "made.mcap", mimeType: "application/octet-stream", buffer: Buffer.from(bytes) };
}

async function openFile(page: Page): Promise<void> {
  await page.setInputFiles("input[type=file]", await recordingFile());
  await until("the recording", () =>
    page.evaluate(() => {
      const replay = window.phalanxReplay;
      return replay.surveyed() === 1 && !replay.loading() && (replay.view()?.frames ?? 0) > 2;
    }));
  await page.locator(".plots").waitFor();
}

async function openNoRecording(page: Page): Promise<void> {
  await page.setInputFiles("input[type=file]", { name: "cut.mcap", mimeType: "", buffer: Buffer.from("no recording") });
  await page.locator(".start > .refused").waitFor();
}

interface RecordingState {
  readonly name: string;
  readonly answer?: unknown; // of the station to the question for its recordings; absent: it offers none
  readonly act?: (page: Page) => Promise<void>;
}

const recordingStates: readonly RecordingState[] = [
  { name: "list", answer: list },
  { name: "no_list" },
  { name: "refused", answer: list, act: openNoRecording },
  { name: "open", act: openFile },
  { name: "keys", act: async (page) => { await openFile(page); await page.keyboard.press("?"); await page.locator(".dialog").waitFor(); } },
  { name: "no_stop", act: async (page) => { await openFile(page); await page.keyboard.press("Escape"); } },
  { name: "selected_time", act: async (page) => { await openFile(page); await page.keyboard.press("End"); await select(page); } },
];

describe.each(recordingStates)("the page of recordings: $name", ({ name, answer, act }) => {
  it("has no violation", async () => {
    const { page, errors } = await opened();
    const given = { contentType: "application/json", body: JSON.stringify(answer) };
    await page.route("**/recordings", (route) => route.fulfill(answer === undefined ? { status: 404 } : given));
    await page.goto(`${site.url}recording.html`);
    await page.locator(answer === undefined ? ".start-box .hint:not(:empty)" : ".recordings").first().waitFor();
    await act?.(page);
    await expectNoViolation(page, name);
    expect(errors).toEqual([]);
    await page.context().close();
  });
});
