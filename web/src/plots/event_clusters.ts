// SPDX-License-Identifier: Apache-2.0
// Events as flags: those that would lie over each other become one.
import { eventLabel, markKind, type Happened, type MarkKind } from "../state/happened";
import { strings } from "../strings";
import type { Span } from "./time_view";

export interface Cluster {
  readonly events: readonly Happened[];
  readonly time: number; // of the first one
  readonly kind: MarkKind; // of the most serious one
  readonly label: string;
}

function kindOf(events: readonly Happened[]): MarkKind {
  const kinds = events.map(({ code }) => markKind(code));
  return kinds.find((kind) => kind === "bad") ?? kinds.find((kind) => kind === "marker") ?? "other";
}

function labelOf(events: readonly Happened[]): string {
  const label = eventLabel(events[0]!.code);
  if (events.length === 1) return label;
  const alike = events.every(({ code }) => eventLabel(code) === label);
  return alike ? strings.plots.several(label, events.length) : strings.plots.events(events.length);
}

/// @param happened  in the order of time
/// @param reach  events that follow so soon are one flag [s]
export function clustersOf(happened: readonly Happened[], span: Span, reach: number): Cluster[] {
  const groups: Happened[][] = [];
  for (const one of happened) {
    if (one.time < span.from || one.time > span.to) continue;
    const group = groups.at(-1);
    if (group && one.time - group[0]!.time < reach) group.push(one);
    else groups.push([one]);
  }
  return groups.map((events) => ({ events, time: events[0]!.time, kind: kindOf(events), label: labelOf(events) }));
}
