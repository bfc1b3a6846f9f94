// SPDX-License-Identifier: Apache-2.0
// Why something was refused, in words. The station's own words are English, and name the value and the remedy.
import { PeopleError } from "./api";
import { words } from "./words";

/// Why the page shows nothing, and what to do about it; both empty where there is no more to say.
export interface Explanation {
  readonly text: string;
  readonly hint: string;
}

/// @throws what it was given if that is no answer of the station: a defect of the page
export function explanation(reason: unknown): Explanation {
  if (!(reason instanceof PeopleError)) throw reason;
  const { message } = reason;
  switch (reason.trouble) {
    case "none":
      return { text: words.noRegistry, hint: words.noRegistryHint };
    case "forbidden":
      return { text: words.forbidden, hint: message };
    case "signed_out":
      return { text: words.signedOut, hint: "" };
    case "busy":
      return { text: words.busy, hint: message };
    case "gone":
      return { text: words.gone, hint: "" };
    case "refused":
      return { text: message, hint: "" };
  }
}

/// Beside the button that was pressed.
export function refusalText(reason: unknown): string {
  if (reason instanceof PeopleError && reason.trouble === "gone") return words.gone;
  return reason instanceof Error ? reason.message : String(reason);
}
