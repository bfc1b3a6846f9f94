// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { readImportReport, streamUrl } from "../../../src/wire/http";

describe("addresses and answers", () => {
  it("the stream lies beside the page", () => {
    expect(streamUrl("http://127.0.0.1:8480/")).toBe("ws://127.0.0.1:8480/stream");
    expect(streamUrl("https://host/a/b/index.html#x")).toBe("wss://host/a/b/stream");
  });

  it("an import's report is taken apart, and nonsense is a refusal", () => {
    const good = '{"ok":true,"report":["a","b"],"findings":["c"],"file":"/x.stl"}';
    expect(readImportReport(good, 200)).toEqual({ ok: true, error: "", report: ["a", "b"], facts: null, findings: ["c"], file: "/x.stl" });
    expect(readImportReport('{"ok":false,"error":"open","report":"one\\ntwo"}', 400)).toMatchObject({ ok: false, error: "open", report: ["one", "two"] });
    const own = { verdict: "usable: a closed solid", triangles: 2404, vertices: 1204, extent_m: [0.061, 0.04, 0.038], closed: true, volume_m3: 5e-5,
      findings: [{ kind: "duplicate_vertices", found: 12, meaning: "merged" }, { kind: "holes", found: 0, meaning: "none" }] };
    const read = readImportReport(JSON.stringify({ ok: true, report: own, file: "/x.stl" }), 200);
    expect(read.facts).toEqual({ verdict: own.verdict, triangles: 2404, vertices: 1204, extent: own.extent_m, closed: true, volume: 5e-5 });
    expect(read.findings).toEqual(["12 duplicate vertices: merged"]);
    expect(readImportReport("Too large", 413)).toMatchObject({ ok: false, error: "Too large" });
    expect(readImportReport("null", 500)).toMatchObject({ ok: false, error: "HTTP 500", findings: [] });
  });
});
