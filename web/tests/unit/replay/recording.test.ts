// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { openRecording } from "../../../src/replay/recording";
import { SourceError } from "../../../src/replay/source";
import { troubleText } from "../../../src/replay/trouble";
import { strings } from "../../../src/strings";
import { bytesOf, event, geometry, kBegin, poses, setup, sourceOf } from "./made_recording";

const words = strings.replay.trouble;
const whole = () => bytesOf([geometry(0, 1), setup(0.001), ...poses(0.01, 3), event(2, "marker", "one")]);
const said = async (bytes: Uint8Array) => troubleText(await openRecording(sourceOf(bytes)).catch((reason: unknown) => reason), "x.mcap");

describe("a recording", () => {
  it("is known by its index alone: length, chunks and what they hold", async () => {
    const bytes = await whole();
    const source = sourceOf(bytes);
    const recording = await openRecording(source);
    expect(recording.layout.begin).toBe(kBegin);
    expect(recording.seconds).toBeCloseTo(0.01 + 179 / 60, 6);
    expect(recording.chunks.length).toBeGreaterThan(10);
    expect(recording.count("/pose")).toBe(180);
    expect(recording.chunks.filter(({ topics }) => topics.has("/event")).length).toBe(1);
    expect(recording.version).toBe("0.1.0");
    const inside = recording.chunks.reduce((sum, { length }) => sum + length, 0);
    expect(inside).toBeGreaterThan(bytes.length / 2);
    expect(source.reads).toBeLessThan(10); // no chunk among them
  });

  it("that is another kind of file, has no end, or is of another program, is refused in words", async () => {
    const bytes = await whole();
    expect(await said(new TextEncoder().encode("time,force\n0,0\n"))).toBe(words.noMcap);
    expect(await said(new Uint8Array())).toBe(words.noMcap);
    expect(await said(bytes.slice(0, bytes.length - 20))).toBe(words.noIndex("x.mcap"));
    expect(await said(bytes.slice(0, 8))).toBe(words.noIndex("x.mcap"));
    expect(await said(await bytesOf([], { topics: ["/camera"] }))).toBe(words.noPoses);
    expect(await said(await bytesOf([setup(0)]))).toBe(words.empty);
  });

  it("of another program is refused, also where its topics have the same names", async () => {
    const messages = poses(0, 1);
    expect(await said(await bytesOf(messages, { topics: ["/pose"], schemas: { "/pose": "geometry_msgs/msg/Pose" } }))).toBe(words.noPoses);
    expect(await said(await bytesOf(messages, { topics: ["/pose"], encoding: "cdr" }))).toBe(words.noPoses);
  });

  it("without an index of messages is read all the same; without statistics it is called damaged, not empty", async () => {
    const messages = [geometry(0, 1), setup(0.001), ...poses(0.01, 1)];
    const recording = await openRecording(sourceOf(await bytesOf(messages, { index: { useMessageIndex: false } })));
    expect(recording.chunks.every(({ topics }) => topics.has("/pose") && topics.has("/setup"))).toBe(true);
    expect(await said(await bytesOf(messages, { index: { useStatistics: false } }))).toBe(words.noIndex("x.mcap"));
  });

  it("whose index leads out of the file is refused before anything of that length is read", async () => {
    const source = sourceOf(await whole());
    const size = await source.size();
    const { chunks } = await openRecording(source);
    const last = chunks.at(-1)!;
    const bytes = await whole();
    const view = new DataView(bytes.buffer);
    for (let at = bytes.length - 8; at > last.offset + last.length; --at) { // the chunk's length in its index
      if (view.getBigUint64(at, true) === BigInt(last.offset) && view.getBigUint64(at + 8, true) === BigInt(last.length)) view.setBigUint64(at + 8, 2n ** 60n, true);
    }
    let longest = 0n;
    const bad = sourceOf(bytes);
    const read = bad.read.bind(bad);
    bad.read = (offset, length) => {
      longest = length > longest ? length : longest;
      return read(offset, length);
    };
    expect(troubleText(await openRecording(bad).catch((reason: unknown) => reason), "x.mcap")).toBe(words.noIndex("x.mcap"));
    expect(longest).toBeLessThanOrEqual(size);
  });

  it("whose index is damaged is not opened, whatever byte of it is", async () => {
    const bytes = await whole();
    let refused = 0;
    for (let at = bytes.length - 37; at < bytes.length - 9; ++at) { // the footer
      const bad = bytes.slice();
      bad[at]! ^= 0xff;
      const opened = await openRecording(sourceOf(bad)).catch((reason: unknown) => reason);
      if (opened instanceof Error) ++refused;
    }
    expect(refused).toBeGreaterThan(20);
  });

  it("that cannot be fetched says why, and not that the file is bad", async () => {
    const source = sourceOf(await whole());
    source.read = () => Promise.reject(new SourceError("refused", ""));
    expect(troubleText(await openRecording(source).catch((reason: unknown) => reason), "")).toBe(words.refused);
    const later = sourceOf(await whole());
    const read = later.read.bind(later);
    let reads = 0;
    later.read = (offset, length) => (++reads > 3 ? Promise.reject(new SourceError("gone", "")) : read(offset, length));
    expect(troubleText(await openRecording(later).catch((reason: unknown) => reason), "")).toBe(words.gone);
  });
});
