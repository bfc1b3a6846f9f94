// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { importSummary, reportLines } from "../../../src/panels/import_words";
import { strings } from "../../../src/strings";
import { refusedReport, type ImportReport, type MeshFacts } from "../../../src/wire/import_report";

const words = strings.object;
const facts: MeshFacts = { verdict: "usable: a closed solid", triangles: 12034, vertices: 6019, extent: [0.1204, 0.085, 0.0051], closed: true, sheets: 0, volume: 5e-5 };
const good: ImportReport = { ...refusedReport(""), ok: true, file: "/meshes/mug.stl", facts };
const summary = (report: Partial<ImportReport>) => importSummary("mug.stl", { ...good, ...report });

describe("the summary of an import", () => {
  it("names the file, its surface, its extents and its triangles", () => {
    expect(summary({})).toBe(words.closed("mug.stl", "120 × 85 × 5.1 mm", "12,034"));
    expect(summary({ facts: { ...facts, closed: false, sheets: 2 } })).toBe(words.sheet("mug.stl", "120 × 85 × 5.1 mm", "12,034"));
    expect(summary({ facts: { ...facts, closed: false } })).toBe(words.shared("mug.stl", "120 × 85 × 5.1 mm", "12,034"));
    expect(summary({ facts: { ...facts, closed: false, sheets: NaN } }), "an older station").toBe(words.sheet("mug.stl", "120 × 85 × 5.1 mm", "12,034"));
    expect(summary({ facts: null })).toBe(words.usable("mug.stl"));
  });

  it("says of a mesh that no hand can hold whether it is too large or too small", () => {
    const sized = (metres: number) => summary({ ok: false, error: "refused in a scene as it stands", facts: { ...facts, extent: [metres, metres / 2, metres] } });
    expect(sized(60)).toBe(words.tooWide("mug.stl", "60,000 × 30,000 × 60,000 mm"));
    expect(sized(0.001)).toBe(words.tooSmall("mug.stl", "1 × 0.5 × 1 mm"));
  });

  it("is the refusal of a file that cannot be read, with the file's name once", () => {
    expect(importSummary("a.stl", refusedReport("a.stl: the file is empty; send another"))).toBe("a.stl: the file is empty; send another");
    expect(importSummary("a.stl", refusedReport(words.tooLarge))).toBe(words.refused("a.stl", words.tooLarge));
  });
});

it("an import's report is lines for people", () => {
  expect(reportLines(good)).toEqual(["usable: a closed solid", "6,019 vertices, 12,034 triangles", "120.4 × 85 × 5.1 mm", "closed, 50.0 cm³"]);
  expect(reportLines({ ...good, facts: { ...facts, closed: false } }).at(-1)).toBe(words.open);
  expect(reportLines({ ...good, facts: null, report: ["fine"] })).toEqual(["fine"]);
});
