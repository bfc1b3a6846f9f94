// SPDX-License-Identifier: Apache-2.0
// The station's answer to an upload: docs/meshes.md.
import { strings } from "../strings";

/// The import's report on a mesh.
export interface ImportReport {
  readonly ok: boolean;
  readonly error: string;
  readonly report: readonly string[]; // lines
  readonly facts: MeshFacts | null;
  readonly findings: readonly string[];
  readonly file: string; // to be set as objects.0.file
  readonly preview: MeshPreview | null; // null: none was sent, or a malformed one
}

/// The import's own report: numbers and findings.
export interface MeshFacts {
  readonly verdict: string;
  readonly triangles: number;
  readonly vertices: number;
  readonly extent: readonly number[]; // [m]
  readonly closed: boolean;
  readonly sheets: number; // surfaces that are not closed
  readonly volume: number; // [m^3]
}

/// The imported mesh for a picture, in the axes of the file.
export interface MeshPreview {
  readonly position: Float32Array; // 3 a vertex [m], from the first vertex: single precision is enough wherever the mesh is
  readonly index: Uint32Array; // 3 a triangle
}

const kMicrometre = 1e-6;

const asRecord = (value: unknown): Record<string, unknown> =>
  typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};
const asText = (value: unknown) => (typeof value === "string" ? value : "");
const asNumber = (value: unknown) => (typeof value === "number" ? value : NaN);

function readFacts(value: unknown): MeshFacts | null {
  const report = asRecord(value);
  if (asText(report["verdict"]) === "") return null;
  const extent = report["extent_m"];
  return {
    verdict: asText(report["verdict"]),
    triangles: asNumber(report["triangles"]),
    vertices: asNumber(report["vertices"]),
    extent: Array.isArray(extent) ? extent.map(asNumber) : [],
    closed: report["closed"] === true,
    sheets: asNumber(report["sheets"]),
    volume: asNumber(report["volume_m3"]),
  };
}

/// Findings in the station's words; of those that were looked for, only what was found.
function readFindings(value: unknown): string[] {
  if (!Array.isArray(value)) return [];
  return value.flatMap((one: unknown) => {
    if (typeof one === "string") return [one];
    const finding = asRecord(one);
    const found = asNumber(finding["found"]);
    if (found === 0) return [];
    return [`${Number.isFinite(found) ? `${found} ` : ""}${asText(finding["kind"]).replaceAll("_", " ")}: ${asText(finding["meaning"])}`];
  });
}

function lines(value: unknown): string[] {
  if (typeof value === "string") return value.split("\n").filter((line) => line.trim() !== "");
  return Array.isArray(value) ? value.map(asText) : [];
}

/// Whole numbers in threes, at least three; null if the value is anything else.
function threes(value: unknown): readonly number[] | null {
  const whole = Array.isArray(value) && value.length > 0 && value.length % 3 === 0 && value.every(Number.isSafeInteger);
  return whole ? (value as number[]) : null;
}

function readPreview(value: unknown): MeshPreview | null {
  const preview = asRecord(value);
  const position = threes(preview["position_um"]);
  const index = threes(preview["triangle"]);
  if (!position || !index?.every((vertex) => vertex >= 0 && 3 * vertex < position.length)) return null;
  return { position: Float32Array.from(position, (at, i) => (at - position[i % 3]!) * kMicrometre), index: Uint32Array.from(index) };
}

/// The report on a file that the station has not read. @param error  what is wrong, and what to do
export function refusedReport(error: string): ImportReport {
  return { ok: false, error, report: [], facts: null, findings: [], file: "", preview: null };
}

/// Takes apart what the station answered; whatever is missing is empty.
export function readImportReport(text: string, status: number): ImportReport {
  let parsed: unknown;
  try {
    parsed = JSON.parse(text);
  } catch {
    return refusedReport(text.trim() || strings.http(status));
  }
  const answer = asRecord(parsed);
  return {
    ok: answer["ok"] === true,
    error: asText(answer["error"]) || (answer["ok"] === true ? "" : strings.http(status)),
    report: lines(answer["report"]),
    facts: readFacts(answer["report"]),
    findings: readFindings(answer["findings"] ?? asRecord(answer["report"])["findings"]),
    file: asText(answer["file"]),
    preview: readPreview(answer["preview"]),
  };
}
