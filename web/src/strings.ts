// SPDX-License-Identifier: Apache-2.0
// The languages of the page, and the one in use: English until this browser remembers another choice. The browser's own language chooses
// none, since a translation that no native speaker has reviewed must be asked for.
import { de } from "./strings/de";
import { en, type Strings } from "./strings/en";
import { lasting } from "./wire/memory";

export type { Strings };

export interface Language {
  readonly code: string;
  readonly texts: Strings;
  readonly reviewed: boolean; // by a native speaker
}

/// The language of the station's texts, too.
export const english: Language = { code: "en", texts: en, reviewed: true };
export const languages: readonly Language[] = [english, { code: "de", texts: de, reviewed: false }];

export const kLanguageKey = "phalanx.language";
export const language: Language = languages.find(({ code }) => code === lasting.get(kLanguageKey)) ?? english;

/// The texts of the language in use.
export const strings: Strings = language.texts;

/// Of two texts of a file the one in the language of the page. @param german  empty: the file has none
export const textOfFile = (plain: string, german: string): string => (language.code === "de" && german !== "" ? german : plain);
