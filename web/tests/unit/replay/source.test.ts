// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { fileSource, SourceError, stationSource, type Fetch } from "../../../src/replay/source";
import { fetchList } from "../../../src/replay/station_list";
import { listTroubleText, troubleText } from "../../../src/replay/trouble";
import { strings } from "../../../src/strings";

const bytes = Uint8Array.from({ length: 1000 }, (_, i) => i % 251);
const words = strings.replay.trouble;

/// A station that has one file.
const station: Fetch = (address, { headers }) => {
  const range = /^bytes=(\d+)-(\d+)$/.exec((headers as Record<string, string>)["Range"] ?? "");
  if (address !== "recordings/a%20b.mcap" || !range) return Promise.resolve(new Response("", { status: 404 }));
  const [from, to] = [Number(range[1]), Number(range[2])];
  return Promise.resolve(new Response(bytes.slice(from, to + 1), { status: 206, headers: { "Content-Range": `bytes ${from}-${Math.min(to, 999)}/1000` } }));
};
const trouble = (reading: Promise<unknown>) => reading.then(() => "", (reason: unknown) => (reason instanceof SourceError ? reason.trouble : String(reason)));
const answers = (status: number, body: BodyInit = ""): Fetch => () => Promise.resolve(new Response(body, { status }));

describe("the bytes of a recording", () => {
  it("are read in parts, from the station and from a file alike", async () => {
    for (const source of [stationSource("a b.mcap", station), fileSource(new File([bytes], "a b.mcap"))]) {
      expect(source.name).toBe("a b.mcap");
      expect(await source.size()).toBe(1000n);
      expect(await source.read(10n, 5n)).toEqual(bytes.slice(10, 15));
      expect(await source.read(999n, 1n)).toEqual(bytes.slice(999));
      expect(await source.read(3n, 0n)).toEqual(new Uint8Array());
    }
  });

  it("that do not come are told apart: refused, missing, gone, or not what was asked for", async () => {
    expect(await trouble(stationSource("other", station).size())).toBe("missing");
    expect(await trouble(stationSource("x", answers(403)).size())).toBe("refused");
    expect(await trouble(stationSource("x", answers(503)).size())).toBe("busy");
    expect(await trouble(stationSource("x", answers(500)).size())).toBe("other");
    expect(await trouble(stationSource("x", answers(200, bytes)).size())).toBe("other"); // the whole file: not what was asked for
    expect(await trouble(stationSource("x", () => Promise.reject(new TypeError("no connection"))).size())).toBe("gone");
    expect(await trouble(stationSource("a b.mcap", station).read(995n, 10n))).toBe("other"); // the file is shorter now
  });
});

it("a file of this computer that was changed is not taken for a station that does not answer", async () => {
  const file = new File([bytes], "a.mcap");
  file.slice = () => Object.assign(new Blob(), { arrayBuffer: () => Promise.reject(new Error("NotReadableError")) });
  expect(await trouble(fileSource(file).read(0n, 8n))).toBe("changed");
  expect(troubleText(new SourceError("changed", ""), "a.mcap")).toBe(words.changed);
});

it("a large part of a file is read in several answers", async () => {
  const whole = Uint8Array.from({ length: 40_000_000 }, (_, i) => i % 251);
  const asked: string[] = [];
  const get: Fetch = (_address, options) => {
    const range = (options.headers as Record<string, string>)["Range"]!;
    asked.push(range);
    const [first, last] = /(\d+)-(\d+)/.exec(range)!.slice(1).map(Number) as [number, number];
    const headers = { "Content-Range": `bytes ${first}-${last}/${whole.length}` };
    return Promise.resolve(new Response(whole.slice(first, last + 1), { status: 206, headers }));
  };
  const read = await stationSource("a.mcap", get).read(5n, 39_999_990n);
  expect(asked).toEqual(["bytes=5-16777220", "bytes=16777221-33554436", "bytes=33554437-39999994"]);
  expect(Buffer.compare(read, whole.subarray(5, 39_999_995))).toBe(0);
});

describe("the station's list", () => {
  it("has the newest first, and leaves out what it cannot name", async () => {
    const answer = {
      folder: "out/recordings",
      recordings: [
        { name: "old.mcap", bytes: 5, begin: 100, seconds: 20, events: 2, gaps: 0, scene: "s", device: "d", opens: true, state: "2 gaps" },
        { bytes: 7 },
        null,
        { name: "new.mcap", begin: 200, state: "being written", seconds: "x" },
      ],
    };
    const list = await fetchList(answers(200, JSON.stringify(answer)));
    expect(list.folder).toBe("out/recordings");
    expect(list.recordings.map(({ name }) => name)).toEqual(["new.mcap", "old.mcap"]);
    expect(list.recordings.map(({ opens }) => opens)).toEqual([false, true]);
    expect(list.recordings[0]!.seconds).toBe(0);
    expect(list.recordings[1]).toMatchObject({ seconds: 20, scene: "s", device: "d" });
  });

  it("that does not come is explained", async () => {
    const said = (get: Fetch) => fetchList(get).then(() => "", listTroubleText);
    expect(await said(answers(403))).toBe(words.refused);
    expect(await said(answers(404))).toBe(words.noList);
    expect(await said(answers(200, "<html>"))).toBe(words.other);
    expect(await said(() => Promise.reject(new TypeError("x")))).toBe(words.gone);
    expect(troubleText(new Error("boom"), "")).toBe(words.unknown("boom"));
  });
});
