// SPDX-License-Identifier: Apache-2.0
// Requests over plain HTTP: shapes, uploads, and the stop while the socket is down.
import { readImportReport, type ImportReport } from "./import_report";

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
