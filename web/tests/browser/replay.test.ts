// SPDX-License-Identifier: Apache-2.0
// The page of recordings: what it shows is what was recorded, and it cannot be mistaken for the cockpit.
import { readdirSync, statSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { beforeAll, describe, expect, it } from "vitest";
import { kOldPose } from "../../src/replay/player";
import { strings } from "../../src/strings";
import { origins } from "./support/geometry";
import { readRecording, type RecordingPage } from "./support/recording_page";
import { stage, unseen, type OwnStation } from "./support/stage";
import { until } from "./support/until";

const words = strings.replay;
const kRecorded = 600_000; // bytes of the recording, some seconds
const kLinked = 0.5; // [s], of the address with which the page is opened
const kMicrometre = 1e-6;
const play = stage();
let file = "";
let recorded: Awaited<ReturnType<typeof readRecording>>;
let station: OwnStation; // lists the recording
let page: RecordingPage;

/// Sets a marker, as another program does.
async function mark({ url }: OwnStation, text: string): Promise<void> {
  const { status } = await fetch(`${url}marker`, { method: "POST", body: text, headers: { Origin: new URL(url).origin } });
  expect(status, "of the marker").toBe(200);
}

beforeAll(async () => {
  const first = await play.ownStation(["first_touch"]);
  const folder = join(first.folder, "out/recordings");
  file = join(folder, await until("a recording", () => readdirSync(folder)[0]));
  await until("steps before the marker", () => statSync(file).size > kRecorded / 2);
  await mark(first, "stimulus 1");
  [station] = await Promise.all([play.ownStation(["first_touch"], 0, first.folder), until("steps after it", () => statSync(file).size > kRecorded)]);
  await first.program.end();
  recorded = await readRecording(file);
  expect(recorded.seconds).toBeGreaterThan(1.5); // there is something to play
  page = await play.openRecordings(station.url, unseen, `?file=${basename(file)}&t=${kLinked}`);
});

/// The displayed moment is the recorded one: its step, and the hand as it is drawn.
async function expectRecorded(what: string, near?: number): Promise<number> {
  const { tick, position, view, samples } = await page.settled(what, (shown) => near === undefined || Math.abs(shown.position - near) < 0.02);
  const last = recorded.poses.filter(({ time }) => time <= position + 1e-7).at(-1) ?? recorded.poses[0]!;
  expect(tick!.tick, `${what}: at ${position} s`).toBe(last.tick.tick);
  expect(tick!.gdpAngle).toEqual(last.tick.gdpAngle);
  origins(last.tick.gdpPose).forEach((point, segment) => point.forEach((value, axis) => expect(Math.abs(view!.shown[segment]![axis]! - value)).toBeLessThan(kMicrometre)));
  const curve = recorded.poses.filter(({ time }) => time <= position + 1e-7 && time > position - 10).length;
  const hole = position - last.time > kOldPose ? 1 : 0; // its sample ends the curves
  expect(samples).toBe(Math.max(1, curve) + hole);
  return position;
}

async function expectNoCockpit(): Promise<void> {
  expect(await page.page.getByRole("button", { name: strings.stop.button }).count()).toBe(0);
  expect(await page.page.getByRole("region", { name: strings.stop.region }).count()).toBe(0);
  expect(await page.page.getByText(words.notLive).isVisible()).toBe(true);
  expect(await page.page.locator("link[rel=icon]").getAttribute("href")).toContain("recording");
  expect(page.sent, "messages to the station").toEqual([]);
}

describe("a recording", () => {
  it("is opened by its address at a moment, and looks like nothing but a recording", async () => {
    await expectRecorded("the moment of the address", kLinked);
    expect(await page.page.title()).toMatch(/^Recording of /);
    expect(await page.page.getByRole("banner").innerText()).toMatch(/^Recording of \d/);
    expect(await page.page.locator(".watermark").isVisible()).toBe(true);
    await expectNoCockpit();
  });

  it("shows the recorded hand wherever the keys lead", async () => {
    const { keyboard } = page.page;
    await keyboard.press("Home");
    // On a busy machine the first pose may come later: then no hand is that of the beginning.
    if (recorded.poses[0]!.time < kOldPose) await expectRecorded("the beginning", 0);
    await keyboard.press("ArrowRight");
    await expectRecorded("a second on", 1);
    const from = await expectRecorded("the same");
    await keyboard.press(".");
    expect(await expectRecorded("a pose on", from + 1 / 60)).toBeGreaterThan(from);
    await keyboard.press("Shift+ArrowLeft");
    await keyboard.press(",");
    expect(await expectRecorded("a pose back", from - 1 / 60)).toBeLessThan(from);
    await keyboard.press("End");
    await expectRecorded("the end", recorded.seconds);
  });

  it("plays, and stands where it is paused", async () => {
    const { keyboard } = page.page;
    const position = () => page.page.evaluate(() => window.phalanxReplay.position());
    await keyboard.press("Home");
    await keyboard.press("Space");
    await page.page.getByRole("button", { name: words.pause, exact: true }).waitFor();
    await until("a second later", async () => (await position()) > 1, () => page.brief());
    await keyboard.press("Space");
    const paused = await expectRecorded("paused");
    expect(paused).toBeGreaterThan(1);
    expect(await position()).toBe(paused);
    const slider = page.page.getByRole("slider", { name: words.position });
    expect(Number(await slider.getAttribute("aria-valuenow"))).toBeCloseTo(paused, 1);
    await slider.click({ position: { x: 2, y: 40 } });
    expect(await expectRecorded("the scrubber's left end")).toBeLessThan(paused);
  });

  it("goes to a marker, by its entry and by keys", async () => {
    const marker = recorded.events.find(({ code }) => code === "marker")!;
    await page.page.getByRole("button", { name: marker.text }).click();
    await expectRecorded("the marker", marker.time);
    await page.page.keyboard.press("End");
    await expectRecorded("the end", recorded.seconds);
    const earlier = [...recorded.events].reverse().find(({ time }) => time < recorded.seconds - 1e-5)!;
    await page.page.keyboard.press("PageUp");
    await expectRecorded("the event before", earlier.time);
    const moment = await expectRecorded("the same");
    await until("the moment in the address", () => Math.abs(Number(new URL(page.page.url()).searchParams.get("t")) - moment) < 0.01, () => page.page.url());
  });

  it("is listed by the station; a file of this computer is opened as well, and one that is no recording is refused in words", async () => {
    await page.page.getByRole("button", { name: words.link }).click();
    expect(await page.page.title()).toBe(words.titleNone);
    await expectNoCockpit();
    const rows = page.page.getByRole("row");
    await rows.nth(2).waitFor(); // the names of the columns, the recording that is being written, and ours
    expect(await rows.filter({ has: page.page.getByRole("button") }).count(), "one is whole").toBe(1);
    const choose = async (path: string) => {
      const chooser = page.page.waitForEvent("filechooser");
      await page.page.getByRole("button", { name: words.choose }).click();
      await (await chooser).setFiles(path);
    };
    const other = join(station.folder, "cut.mcap");
    writeFileSync(other, "no recording");
    await choose(other);
    await page.page.getByRole("alert").filter({ hasText: words.trouble.noMcap }).waitFor();
    await choose(file);
    const tick = () => page.page.evaluate(() => String(window.phalanxReplay.tick()?.tick));
    await until("the file's first step", async () => (await tick()) === String(recorded.poses[0]!.tick.tick), tick);
    expect(await page.page.title()).toMatch(/^Recording of /);
    await expectNoCockpit();
  });
});
