// SPDX-License-Identifier: Apache-2.0
// Waiting for something to become so. Never an assertion on how long it takes: the limit is there against hangs only.

export const kHangMs = 600_000;
const kBetweenMs = 40;

export const pause = (ms: number) => new Promise<void>((done) => setTimeout(done, ms));

/// What `get` gives once it is neither undefined nor false.
/// @throws Error that says what was waited for, and what was there instead
export async function until<T>(
  what: string,
  get: () => T | Promise<T>,
  otherwise: () => unknown = () => "",
  limitMs = kHangMs,
): Promise<Exclude<T, undefined | false | null>> {
  const giveUp = Date.now() + limitMs;
  for (;;) {
    const value = await get();
    if (value !== undefined && value !== false && value !== null) return value as Exclude<T, undefined | false | null>;
    if (Date.now() > giveUp) throw new Error(`waited in vain for: ${what}. ${String(await otherwise())}`);
    await pause(kBetweenMs);
  }
}
