// SPDX-License-Identifier: Apache-2.0
// Why a recording cannot be opened, in words.
import { strings } from "../strings";
import { DecoderError } from "./decoder";
import { FileError } from "./recording";
import { SourceError } from "./source";

const words = strings.replay.trouble;

/// @param name  of the file
export function troubleText(reason: unknown, name: string): string {
  if (reason instanceof SourceError) {
    return words[reason.trouble];
  }
  if (reason instanceof FileError) {
    const texts = { noMcap: words.noMcap, noIndex: words.noIndex(name), noPoses: words.noPoses, empty: words.empty };
    return texts[reason.trouble];
  }
  if (reason instanceof DecoderError) return words.thread;
  return words.unknown(reason instanceof Error ? reason.message : String(reason));
}

/// Of the list of a station.
export function listTroubleText(reason: unknown): string {
  return reason instanceof SourceError && reason.trouble === "missing" ? words.noList : troubleText(reason, "");
}
