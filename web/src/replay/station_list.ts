// SPDX-License-Identifier: Apache-2.0
// The recordings that the station lists.
import { ask, SourceError, type Fetch } from "./source";

export interface Listed {
  readonly name: string;
  readonly bytes: number;
  readonly begin: number; // UTC [s]
  readonly seconds: number;
  readonly events: number;
  readonly gaps: number;
  readonly scene: string;
  readonly device: string;
  readonly opens: boolean;
  readonly state: string; // in words, also why it cannot be opened
}

export interface StationList {
  readonly folder: string;
  readonly recordings: readonly Listed[]; // newest first
}

const asText = (value: unknown) => (typeof value === "string" ? value : "");
const asNumber = (value: unknown) => (typeof value === "number" && Number.isFinite(value) ? value : 0);

/// Takes the station's answer apart; an entry without a name is left out.
export function readList(parsed: unknown): StationList {
  const answer = (parsed ?? {}) as Record<string, unknown>;
  const entries = Array.isArray(answer["recordings"]) ? (answer["recordings"] as unknown[]) : [];
  const recordings = entries.map((entry) => {
    const one = (entry ?? {}) as Record<string, unknown>;
    return {
      name: asText(one["name"]),
      bytes: asNumber(one["bytes"]),
      begin: asNumber(one["begin"]),
      seconds: asNumber(one["seconds"]),
      events: asNumber(one["events"]),
      gaps: asNumber(one["gaps"]),
      scene: asText(one["scene"]),
      device: asText(one["device"]),
      opens: one["opens"] === true,
      state: asText(one["state"]),
    };
  });
  return { folder: asText(answer["folder"]), recordings: recordings.filter(({ name }) => name !== "").sort((a, b) => b.begin - a.begin) };
}

/// @throws SourceError
export async function fetchList(get: Fetch = (address, options) => fetch(address, options)): Promise<StationList> {
  const response = await ask(get, "recordings", { cache: "no-store" });
  try {
    return readList(await response.json());
  } catch (reason) {
    throw new SourceError("other", String(reason));
  }
}
