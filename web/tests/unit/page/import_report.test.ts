// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { readImportReport } from "../../../src/wire/import_report";

/// A tetrahedron, 10 km from the origin of its file.
const far = 1e10; // [um]
const tetrahedron = {
  position_um: [far, 0, 0, far + 60_000, 0, 0, far, 40_000, 0, far, 0, 50_001],
  triangle: [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2],
};
const read = (preview: unknown) => readImportReport(JSON.stringify({ ok: true, file: "/x.stl", preview }), 200);

describe("the report of an import", () => {
  it("is taken apart, and nonsense is a refusal", () => {
    const good = '{"ok":true,"report":["a","b"],"findings":["c"],"file":"/x.stl"}';
    expect(readImportReport(good, 200)).toEqual({ ok: true, error: "", report: ["a", "b"], facts: null, findings: ["c"], file: "/x.stl", preview: null });
    expect(readImportReport('{"ok":false,"error":"open","report":"one\\ntwo"}', 400)).toMatchObject({ ok: false, error: "open", report: ["one", "two"] });
    const own = { verdict: "usable: a closed solid", triangles: 2404, vertices: 1204, extent_m: [0.061, 0.04, 0.038], closed: true, sheets: 0, volume_m3: 5e-5,
      findings: [{ kind: "duplicate_vertices", found: 12, meaning: "merged" }, { kind: "holes", found: 0, meaning: "none" }] };
    const answer = readImportReport(JSON.stringify({ ok: true, report: own, file: "/x.stl" }), 200);
    expect(answer.facts).toEqual({ verdict: own.verdict, triangles: 2404, vertices: 1204, extent: own.extent_m, closed: true, sheets: 0, volume: 5e-5 });
    expect(answer.findings).toEqual(["12 duplicate vertices: merged"]);
    expect(readImportReport("Too large", 413)).toMatchObject({ ok: false, error: "Too large", preview: null });
    expect(readImportReport("null", 500)).toMatchObject({ ok: false, error: "HTTP 500", findings: [], preview: null });
  });

  it("has the mesh to the micrometre, wherever it lies in its file", () => {
    const { preview } = read(tetrahedron);
    expect([...preview!.index]).toEqual(tetrahedron.triangle);
    [0, 0, 0, 0.06, 0, 0, 0, 0.04, 0, 0, 0, 0.050001].forEach((metres, i) => expect(preview!.position[i], `${i}`).toBeCloseTo(metres, 7));
  });

  it("is whole without a preview, and with one that is malformed", () => {
    const { position_um, triangle } = tetrahedron;
    const malformed: readonly (readonly [string, unknown])[] = [
      ["none", undefined], ["null", null], ["a text", "AAAA"], ["a list", [position_um, triangle]],
      ["no positions", { triangle }], ["no triangles", { position_um }],
      ["empty positions", { position_um: [], triangle }], ["empty triangles", { position_um, triangle: [] }],
      ["a coordinate too few", { position_um: position_um.slice(1), triangle }], ["a corner too few", { position_um, triangle: triangle.slice(1) }],
      ["a fraction of a vertex", { position_um, triangle: [0, 1, 1.5] }], ["a vertex before the first", { position_um, triangle: [0, 1, -1] }],
      ["a vertex after the last", { position_um, triangle: [0, 1, 4] }], ["not a number", { position_um: [0, 0, null, ...position_um.slice(3)], triangle }],
      ["a text for a number", { position_um: ["0", 0, 0, ...position_um.slice(3)], triangle }], ["a number without bound", { position_um: [1e300, 0, 0, ...position_um.slice(3)], triangle }],
    ];
    for (const [what, preview] of malformed) expect(read(preview), what).toMatchObject({ ok: true, file: "/x.stl", preview: null });
  });
});
