// SPDX-License-Identifier: Apache-2.0
// Requests over plain HTTP: shapes, uploads, and the stop while the socket is down.
import { strings } from "../strings";

const kGeometryMs = 10_000;
const kStopMs = 2000;
const kPageMs = 5000;
const kForbidden = 403;

/// The stream's address beside the page's, whatever folder or tunnel the page came through.
export function streamUrl(page: string): string {
  const url = new URL("stream", page);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  url.hash = "";
  return url.href;
}

/// The bytes of a Geometry.
export async function fetchGeometry(revision: number): Promise<ArrayBuffer> {
  const response = await fetch(`geometry/${revision}`, { signal: AbortSignal.timeout(kGeometryMs) });
  if (!response.ok) throw new Error(`geometry/${revision}: ${response.status}`);
  return response.arrayBuffer();
}

/// Whether the station refuses this page's own address; false too where it does not answer.
export async function linkExpired(): Promise<boolean> {
  try {
    const response = await fetch(location.href, { cache: "no-store", signal: AbortSignal.timeout(kPageMs) });
    return response.status === kForbidden;
  } catch {
    return false;
  }
}

/// @returns whether the station confirmed it
export async function postStop(secret: string): Promise<boolean> {
  try {
    const response = await fetch("stop", {
      method: "POST",
      headers: { "X-Phalanx-Page": secret },
      signal: AbortSignal.timeout(kStopMs),
    });
    return response.ok;
  } catch {
    return false;
  }
}

/// The import's report on a mesh.
export interface ImportReport {
  readonly ok: boolean;
  readonly error: string;
  readonly report: readonly string[]; // lines
  readonly facts: MeshFacts | null;
  readonly findings: readonly string[];
  readonly file: string; // to be set as objects.0.file
}

/// The import's own report: numbers and findings.
export interface MeshFacts {
  readonly verdict: string;
  readonly triangles: number;
  readonly vertices: number;
  readonly extent: readonly number[]; // [m]
  readonly closed: boolean;
  readonly volume: number; // [m^3]
}

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

/// Takes apart what the station answered; whatever is missing is empty.
export function readImportReport(text: string, status: number): ImportReport {
  let parsed: unknown;
  try {
    parsed = JSON.parse(text);
  } catch {
    return { ok: false, error: text.trim() || strings.http(status), report: [], facts: null, findings: [], file: "" };
  }
  const answer = asRecord(parsed);
  return {
    ok: answer["ok"] === true,
    error: asText(answer["error"]) || (answer["ok"] === true ? "" : strings.http(status)),
    report: lines(answer["report"]),
    facts: readFacts(answer["report"]),
    findings: readFindings(answer["findings"] ?? asRecord(answer["report"])["findings"]),
    file: asText(answer["file"]),
  };
}

/// @param sizeMm  largest extent; 0 keeps the file's numbers in `unit`
/// @param signal  gives it up
/// @throws TypeError if there is no connection, AbortError if it was given up
export async function uploadMesh(secret: string, file: File, sizeMm: number, unit: string, signal: AbortSignal): Promise<ImportReport> {
  const query = new URLSearchParams({ name: file.name, size_mm: String(sizeMm), unit });
  const response = await fetch(`mesh?${query.toString()}`, {
    method: "POST",
    headers: { "X-Phalanx-Page": secret, "Content-Type": "application/octet-stream" },
    body: file,
    signal,
  });
  return readImportReport(await response.text(), response.status);
}
