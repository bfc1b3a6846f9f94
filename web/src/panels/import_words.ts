// SPDX-License-Identifier: Apache-2.0
// An import's report for people: one sentence, and the details in lines.
import { strings } from "../strings";
import type { ImportReport, MeshFacts } from "../wire/import_report";

const words = strings.object;
const kGraspable = 1; // [m] a largest extent that is refused is above it, or far below

const count = (value: number) => value.toLocaleString(strings.figures);
const extentOf = (facts: MeshFacts, digits: (millimetres: number) => number) =>
  words.extent(
    facts.extent
      .map((metres) => 1000 * metres)
      .map((millimetres) => millimetres.toLocaleString(strings.figures, { maximumFractionDigits: digits(millimetres) }))
      .join(" × "),
  );

/// Says in one sentence whether the mesh can be felt, or why not and what to do.
export function importSummary(name: string, { ok, error, facts }: ImportReport): string {
  if (!facts) return ok ? words.usable(name) : error.startsWith(name) ? error : words.refused(name, error);
  const extent = extentOf(facts, (millimetres) => (millimetres < 10 ? 1 : 0));
  if (!ok) return Math.max(...facts.extent) > kGraspable ? words.tooWide(name, extent) : words.tooSmall(name, extent);
  const sentence = facts.closed ? words.closed : facts.sheets === 0 ? words.shared : words.sheet;
  return sentence(name, extent, count(facts.triangles));
}

/// Writes the report in lines.
export function reportLines(report: ImportReport): string[] {
  const { facts } = report;
  if (!facts) return [...report.report];
  return [
    facts.verdict,
    words.counts(count(facts.vertices), count(facts.triangles)),
    extentOf(facts, () => 1),
    facts.closed ? words.volume((facts.volume * 1e6).toFixed(1)) : words.open,
  ];
}
