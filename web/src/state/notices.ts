// SPDX-License-Identifier: Apache-2.0
// Notices as people read them: a slider that is dragged is one change, not twenty.
import type { Notice } from "../gen/phalanx/cockpit_pb";

const kTogether = 2; // [s]

/// The keys of a notice "set": "a.b = 1, c = 2" without the values.
const keysOf = (notice: Notice) => [...notice.text.matchAll(/(?:^|, )([\w.]+) = /g)].map((match) => match[1]).join();

/// Whether the later one says the same as the earlier, anew.
export function continues(earlier: Notice | undefined, later: Notice): boolean {
  return (
    earlier !== undefined &&
    earlier.code === "set" &&
    later.code === "set" &&
    earlier.who === later.who &&
    later.unixTime - earlier.unixTime <= kTogether &&
    keysOf(later) !== "" &&
    keysOf(earlier) === keysOf(later)
  );
}

/// Of notices that continue each other only the last.
export function merged(notices: readonly Notice[]): readonly Notice[] {
  return notices.filter((notice, i) => {
    const next = notices[i + 1];
    return next === undefined || !continues(notice, next);
  });
}
