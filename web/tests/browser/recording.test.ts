// SPDX-License-Identifier: Apache-2.0
// The recording of a run: what the page says of it, and whether an independent reader accepts it, also after the program was killed.
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { type McapIndexedReader, McapStreamReader } from "@mcap/core";
import { describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import { compareBag, compareScene } from "./support/other_readers";
import { byIndexOf, decompressHandlers } from "./support/mcap";
import { programPath } from "./support/program";
import { stage, unseen } from "./support/stage";
import { until } from "./support/until";

const play = stage();

const recordings = (folder: string) => readdirSync(join(folder, "out/recordings")).map((name) => join(folder, "out/recordings", name));

/// All messages by topic, read from the beginning to the end, with all checksums.
function streamed(file: string): Map<string, number> {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(readFileSync(file));
  const topics = new Map<number, string>();
  const counts = new Map<string, number>();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Channel") topics.set(record.id, record.topic);
    if (record.type !== "Message") continue;
    const topic = topics.get(record.channelId)!;
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
  }
  expect(reader.done()).toBe(true);
  return counts;
}

/// The same through the index at its end.
async function indexed(file: string): Promise<{ counts: Map<string, number>; reader: McapIndexedReader }> {
  const reader = await byIndexOf(file);
  const counts = new Map<string, number>();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const topic = reader.channelsById.get(message.channelId)!.topic;
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
  }
  return { counts, reader };
}

describe("the recording", () => {
  it("is shown in the page, and an independent reader accepts it", async () => {
    const station = await play.ownStation(["first_touch"]);
    const page = await play.open(station.url, unseen);
    await page.untilRunning();
    await page.untilState("a recording with something in it", (state) => (state.recording?.bytes ?? 0n) > 400_000n);
    expect(page.stream.state!.recording!.file).toMatch(/^out\/recordings\/.*\.mcap$/);
    expect(page.stream.state!.recording!.freeBytes).toBeGreaterThan(0n);
    expect(await page.page.locator(".chip-recording").textContent()).toBe(strings.recording.on);
    await page.stopButton.click();
    await page.untilStopped();
    await station.program.end();
    const [file] = recordings(station.folder);
    const counts = streamed(file!);
    expect(counts.get("/setup")).toBe(1);
    expect(counts.get("/geometry")).toBe(1);
    expect(counts.get("/step")).toBeGreaterThan(100);
    expect(counts.get("/pose")).toBeGreaterThan(10);
    expect(counts.get("/event"), "the stop").toBeGreaterThan(0);
    const { counts: byIndex, reader } = await indexed(file!);
    expect(byIndex).toEqual(counts);
    expect(Number(reader.statistics!.messageCount)).toBe([...counts.values()].reduce((sum, count) => sum + count, 0));
    expect([...reader.schemasById.values()].map((schema) => schema.encoding)).toEqual(Array(12).fill("protobuf"));
    const said = execFileSync(programPath(), ["replay", file!], { encoding: "utf8" });
    expect(said).toContain("every force, angle and command has the same bits");
    const bag = join(station.folder, "bag");
    execFileSync(programPath(), ["session", "export", file!, "--format", "ros2", "--out", bag, "--quiet"]);
    await compareBag(bag, file!);
    await compareScene(file!);
  });

  it("of the running session shows the hand of an earlier moment while the plots are paused", async () => {
    const station = await play.ownStation(["first_touch"]);
    const page = await play.open(station.url, unseen);
    await page.ready();
    await page.untilTouching();
    const atPause = page.stream.newest!.tick;
    await page.untilState("the touch on the disk", (state) => (state.recording?.bytes ?? 0n) > 400_000n);
    await page.untilLater(2);
    await page.button(strings.plots.pause).click();
    const { tick: paused, time: pausedAt } = page.stream.newest!;
    await page.untilState("what the plots show on the disk", (state) => state.time - (state.recording?.unsaved ?? 0) > pausedAt);
    const note = page.page.locator(".past-note");
    expect(await note.textContent()).toContain(strings.past.hint);
    const plot = (await page.page.locator(".plot-area .u-over").first().boundingBox())!;
    const pointAt = async (share: number) => {
      await page.page.mouse.move(plot.x + share * plot.width, plot.y + plot.height / 2);
      await until("the hand of that moment", async () => (await page.page.locator(".view-past").count()) === 1, () => note.textContent());
      let before = 0n;
      return until("it is drawn, and stays", async () => {
        const { tick } = (await page.probe())!; // 0: nothing has been drawn yet
        const stays = tick === before;
        before = tick;
        return stays && tick > 0n && tick < paused - 60n && tick; // 60: what is drawn of the present may be so old
      }, () => page.brief());
    };
    const steps = 0.08 * 10 / page.stream.state!.loop!.period; // 8 % of a plot of 10 s
    // In the plots (10 s) the mark goes to the nearest tick that the page has. A busy computer leaves ticks out.
    const had = page.stream.ticks.filter(({ tick }) => tick <= paused && Number(paused - tick) < 12.5 * steps);
    const gap = Math.max(...had.slice(1).map(({ tick }, i) => Number(tick - had[i]!.tick)));
    let seen: bigint[] = [];
    const later = await until("two hands that are 8 % of the plot apart, and the second stays while the station goes on", async () => {
      seen = [await pointAt(0.85), await pointAt(0.93)]; // until it has come from the disk, the hand of the moment before is drawn
      if (Math.abs(Number(seen[1]! - seen[0]!) - steps) >= 0.1 * steps + gap) return false;
      await page.untilLater(0.5);
      return (await page.probe())!.tick === seen[1]! && seen[1]!;
    }, () => `${seen.join(" and ")} were drawn, ${steps} steps should lie between; of the ticks up to ${gap} in a row are missing`);
    expect(later).toBeGreaterThan(atPause);
    await page.page.mouse.move(1, 1);
    await page.stopButton.click();
    await page.untilStopped();
    expect((await page.probe())!.tick).toBe(later);
    await page.button(strings.past.now).click();
    await until("the hand of now", async () => (await page.probe())!.tick > later);
    expect(await page.page.locator(".view-past").count()).toBe(0);
    expect(await note.isVisible()).toBe(false);
    expect(page.errors).toEqual([]);
  });

  it("of a killed program is repaired, and is accepted then", async () => {
    const station = await play.ownStation(["first_touch"]);
    const page = await play.open(station.url, unseen);
    await page.untilState("a recording with something in it", (state) => (state.recording?.bytes ?? 0n) > 400_000n);
    await station.program.kill();
    const [file] = recordings(station.folder);
    const said = execFileSync(programPath(), ["session", "repair", file!], { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
    expect(said).toBe("");
    expect(existsSync(`${file}.torn`)).toBe(true);
    expect((await indexed(file!)).counts).toEqual(streamed(file!));
    expect(execFileSync(programPath(), ["replay", file!], { encoding: "utf8" })).toContain("0 different");

    // The same file, cut anywhere behind its beginning.
    const whole = readFileSync(file!);
    let seed = 22;
    for (let i = 0; i < 25; ++i) {
      seed = (seed * 48271) % 2147483647;
      const length = 60_000 + (seed % (whole.length - 60_000));
      const cut = join(station.folder, "cut.mcap");
      writeFileSync(cut, whole.subarray(0, length));
      execFileSync(programPath(), ["session", "repair", cut], { stdio: "ignore" });
      const { counts } = await indexed(cut);
      expect(counts, `case ${i}, length ${length}`).toEqual(streamed(cut));
    }
  });
});
