// SPDX-License-Identifier: Apache-2.0
// A page in long use: scenes, panels, views, plots and dialogs come and go, and nothing of them is kept.
// PHALANX_MEMORY_SECONDS: how long, 60 where it is not stated.
import type { CDPSession, Locator } from "playwright-core";
import { beforeAll, expect, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { stage, unseen } from "./support/stage";
import { until } from "./support/until";

const kSeconds = Number(process.env["PHALANX_MEMORY_SECONDS"] ?? 60);
const kHangMs = 900_000 + 1000 * kSeconds;
// Rounds: lazy parts are loaded, code is compiled, the view has found its quality. When V8 has compiled uPlot's constructor, it keeps the
// first getter that this defines as part of the shape of its objects, and with it one plot, for as long as the page lives.
const kWarmUp = 3;
const kScenes = ["squeeze_ball", "grasp_mug", "first_touch"]; // memory is measured in the last one
const kHeap = 4e6; // [bytes]: 200 notices that the page keeps, code that is compiled late, caches of the browser
const kNoticeNodes = 9; // of the list: an entry, a time and three spans, and their texts
const kTexts = 20; // nodes: texts that are empty at times
const play = stage();
let cockpit: CockpitPage;
let browserSide: CDPSession;

beforeAll(async () => {
  const station = await play.station(kScenes.at(-1));
  cockpit = await play.open(station.url, { ...unseen, viewport: { width: 1440, height: 1000 } }); // high enough for all cards
  browserSide = await cockpit.page.context().newCDPSession(cockpit.page);
  await browserSide.send("Performance.enable");
  await cockpit.untilRunning();
});

/// Presses a control. Two frames later the page shows what follows.
async function press(control: Locator): Promise<void> {
  await control.evaluate((element) => (element as HTMLElement).click());
  await cockpit.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

async function loadScene(scene: string): Promise<void> {
  const name = strings.scene.names[scene]!;
  await press(cockpit.page.locator(".card", { has: cockpit.page.getByText(name, { exact: true }) }));
  await cockpit.untilState(`the scene ${scene}`, (state) => state.scene === scene && state.busy === "" && !state.stationGone);
  await cockpit.untilRunning();
  await cockpit.untilTouching();
}

async function usePanels(): Promise<void> {
  const { page } = cockpit;
  await press(page.getByRole("tab", { name: strings.tabs.expert }));
  const search = page.getByRole("searchbox", { name: strings.settings.search });
  for (const words of ["force", ""]) await search.fill(words);
  for (const name of ["device", "people", "touch"] as const) await press(page.getByRole("tab", { name: strings.tabs[name] }));
  for (const newtons of [0.6, 0.5]) await cockpit.setStiffness(newtons);
}

async function useView(): Promise<void> {
  const words = strings.view;
  const { page } = cockpit;
  for (const name of Object.values(words.presets)) await press(cockpit.button(name));
  await press(page.locator(".view-parts > summary"));
  for (const count of [3, 2, 1]) await press(page.getByRole("radio", { name: words.viewCount(count) }));
  for (const part of [words.parts.skin, words.parts.skin]) await press(cockpit.switch(part));
  await press(page.locator(".view-parts > summary"));
  for (let i = 0; i < 2; ++i) await press(cockpit.switch(strings.look.light));
}

async function usePlots(): Promise<void> {
  const words = strings.plots;
  const { page } = cockpit;
  for (const subject of [words.subjects.segments, words.subjects.joints, words.subjects.digits]) {
    await press(cockpit.button(subject));
    for (const seconds of [60, 300, 10]) await press(cockpit.button(words.windows(seconds)));
  }
  await page.focus(".plot");
  for (const key of ["End", "Shift+ArrowLeft", "Shift+ArrowLeft", "Enter", "Backspace", "Delete"]) await page.keyboard.press(key);
  for (const name of [words.pause, words.resume]) await press(cockpit.button(name));
}

async function useDialogs(): Promise<void> {
  const close = cockpit.button(strings.look.close);
  for (const opener of [cockpit.button(strings.look.help), cockpit.page.locator(".card-own")]) {
    await press(opener);
    await press(close);
  }
}

async function useAll(): Promise<void> {
  for (const scene of kScenes) await loadScene(scene);
  await usePanels();
  await useView();
  await usePlots();
  await useDialogs();
}

/// What the page holds when all that can be freed has been freed.
async function held() {
  const { page } = cockpit;
  await until("notices that have gone", async () => (await page.locator(".toast").count()) === 0);
  for (let i = 0; i < 2; ++i) await browserSide.send("HeapProfiler.collectGarbage");
  const { metrics } = await browserSide.send("Performance.getMetrics");
  const metric = (name: string) => metrics.find((one) => one.name === name)!.value;
  const { usedSize, embedderHeapUsedSize, backingStorageSize } = await browserSide.send("Runtime.getHeapUsage");
  const { geometries, textures } = (await cockpit.probe())!;
  return {
    bytes: usedSize + embedderHeapUsedSize + backingStorageSize,
    nodes: metric("Nodes") - kNoticeNodes * (await page.locator(".notices > li").count()),
    listeners: metric("JSEventListeners"),
    geometries,
    textures,
  };
}

it("keeps nothing of what has come and gone", async () => {
  for (let i = 0; i < kWarmUp; ++i) await useAll();
  const before = await held();
  const began = Date.now();
  let rounds = 0;
  do {
    await useAll();
    ++rounds;
  } while (Date.now() - began < 1000 * kSeconds);
  const after = await held();
  const seconds = ((Date.now() - began) / 1000).toFixed(0);
  console.log(`${rounds} rounds in ${seconds} s: before ${JSON.stringify(before)}, after ${JSON.stringify(after)}`);
  expect.soft(after.bytes - before.bytes, "bytes").toBeLessThan(kHeap);
  // Of what each round leaves behind there are at least as many as rounds.
  expect.soft(after.nodes - before.nodes, "nodes").toBeLessThan(kTexts + rounds);
  for (const what of ["listeners", "geometries", "textures"] as const) expect.soft(after[what] - before[what], what).toBeLessThan(rounds);
}, kHangMs);
