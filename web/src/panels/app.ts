// SPDX-License-Identifier: Apache-2.0
// The objects that every panel gets: the store, the requests to the station, and the text of a refusal.
import type { Store } from "../state/store";
import { strings } from "../strings";
import type { Answer } from "../wire/connection";
import type { Change, Host } from "../wire/host";
import type { ImportReport } from "../wire/import_report";
import { plainWords } from "./plain_words";

export interface App {
  readonly store: Store;
  readonly host: Host;
  readonly upload: (file: File, sizeMm: number, unit: string, signal: AbortSignal) => Promise<ImportReport>;
  readonly dialogs: HTMLElement; // where dialogs stand; never over Stop
  readonly takeControl: () => void; // asks first
}

/// @returns the text beside the control; empty: done
export function refusal(answer: Answer): string {
  return answer.ok ? "" : plainWords(answer.error) || strings.notSent;
}

/// Requests several changes as one. @param dragging  as Host's. @returns the refusal in the host's words; empty: done
export async function change(app: App, changes: readonly Change[], dragging = false): Promise<string> {
  for (const [key, value] of changes) app.store.asked(key, value);
  const answer = await app.host.set(changes, dragging);
  for (const [key, value] of changes) app.store.answered(key, value, answer.ok);
  app.store.tell("own");
  return refusal(answer);
}
