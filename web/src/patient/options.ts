// SPDX-License-Identifier: Apache-2.0
// The therapist's choices for this screen. They are in the address, so that the therapist's page can open the screen with them, and in this
// browser's memory.
import { lasting } from "../wire/memory";
import type { GameOptions, Side } from "./game";

export interface Options extends GameOptions {
  readonly language: string; // code; one that is not known means English
  readonly sound: boolean;
  readonly speech: boolean;
}

const kKey = "phalanx.patient";
const kCockpitLanguage = "phalanx.language"; // strings.ts
const flags = ["aphasia", "numbers", "sound", "speech", "calm", "contrast"] as const;
const defaults: Options = { language: "", aphasia: false, numbers: false, cues: "centre", sound: true, speech: true, calm: false, contrast: false };

const sideOf = (text: string | null): Side | "centre" | undefined => (text === "left" || text === "right" || text === "centre" ? text : undefined);

/// Overwrites the options that a query names: "lang=de&aphasia=1&cues=left".
function read(base: Options, query: string): Options {
  const given = new URLSearchParams(query);
  const chosen: Record<string, unknown> = { ...base };
  for (const flag of flags) {
    const value = given.get(flag);
    if (value === "1" || value === "0") chosen[flag] = value === "1";
  }
  const language = given.get("lang");
  if (language !== null && /^[a-z]{2}$/.test(language)) chosen["language"] = language;
  return { ...(chosen as unknown as Options), cues: sideOf(given.get("cues")) ?? base.cues };
}

/// As a query, without its question mark.
export function queryOf(options: Options): string {
  const query = new URLSearchParams({ lang: options.language, cues: options.cues });
  for (const flag of flags) query.set(flag, options[flag] ? "1" : "0");
  return query.toString();
}

/// The options of the address; what it does not name is as this browser remembers it. Less motion and high contrast follow the system's wish until one is chosen.
export function optionsOf(query: string): Options {
  const wish = (feature: string) => window.matchMedia?.(feature).matches ?? false;
  const base = { ...defaults, language: lasting.get(kCockpitLanguage), calm: wish("(prefers-reduced-motion: reduce)"), contrast: wish("(prefers-contrast: more)") };
  return read(read(base, lasting.get(kKey)), query);
}

/// Keeps the options in the browser's memory and in the address.
export function keep(options: Options): void {
  const query = queryOf(options);
  lasting.set(kKey, query);
  const url = new URL(location.href);
  for (const [name, value] of new URLSearchParams(query)) url.searchParams.set(name, value);
  history.replaceState(history.state, "", url.href);
}
