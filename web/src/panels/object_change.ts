// SPDX-License-Identifier: Apache-2.0
// Another object in the place of the first.
import type { State } from "../gen/phalanx/cockpit_pb";
import { find } from "../state/keys";
import { table } from "../state/toml";
import type { Change } from "../wire/host";

const kPlace = ["position_mm", "rotation_deg"];

/// Replaces the whole object, because sizes of another shape would be refused. Its place stays, unless the entries state another; earlier
/// changes of it are removed.
/// @param entries  key without "objects.0.", value as in a file
export function replaceObject(state: State | undefined, entries: readonly (readonly [string, string])[]): readonly Change[] {
  const earlier = (state?.changed ?? []).filter((one) => one.key.startsWith("objects.0."));
  const kept = kPlace.filter((name) => !entries.some(([key]) => key === name));
  const place = kept.flatMap((name): [string, string][] => {
    const value = find(state?.value, `objects.0.${name}`);
    return value === undefined ? [] : [[name, value]];
  });
  return [...earlier.map((one): Change => [one.key, ""]), ["objects.0", table([...entries, ...place])]];
}
