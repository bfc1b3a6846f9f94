// SPDX-License-Identifier: Apache-2.0
// The session of the page of patients, for the pages of the same browser and address that read encrypted recordings. It is in the memory of
// the open page of patients alone: the other pages ask that page, and get nothing once it is closed or signed out.
import type { Fetch } from "../replay/source";

const kChannel = "phalanx.session"; // a BroadcastChannel: pages of another address do not hear it
const kQuestion = "session?";
const kAnswerMs = 300;
const kNoKey = 409;

/// Answers the pages that ask. @param session  gives the secret; empty: none
export function offerSession(session: () => string): void {
  const channel = new BroadcastChannel(kChannel);
  channel.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
    if (data === kQuestion && session() !== "") channel.postMessage({ session: session() });
  });
}

/// Asks the open page of patients. @returns the secret; empty if no page answers in time
export function askSession(): Promise<string> {
  const channel = new BroadcastChannel(kChannel);
  return new Promise<string>((found) => {
    const timer = setTimeout(() => found(""), kAnswerMs);
    channel.addEventListener("message", ({ data }: MessageEvent<unknown>) => {
      const session = typeof data === "object" && data !== null && "session" in data ? data.session : undefined;
      if (typeof session !== "string") return;
      clearTimeout(timer);
      found(session);
    });
    channel.postMessage(kQuestion);
  }).finally(() => channel.close());
}

/// A fetch that has the session in its header. It asks for the session where it has none, and again where the station refuses the one it has.
/// @param list  of recordings: the station refuses none, and states which ones it cannot read
export function signedFetch(get: Fetch, ask: () => Promise<string> = askSession): (list: boolean) => Fetch {
  let session = "";
  const send = (address: string, options: RequestInit) =>
    get(address, session === "" ? options : { ...options, headers: { ...(options.headers as Record<string, string> | undefined), "X-Phalanx-Session": session } });
  return (list) => async (address, options) => {
    if (list) session = await ask();
    const response = await send(address, options);
    if (list || response.status !== kNoKey) return response;
    const newest = await ask();
    if (newest === "" || newest === session) return response;
    session = newest;
    return send(address, options);
  };
}

/// Of this page.
export const pageFetch = signedFetch((address, options) => fetch(address, options));
