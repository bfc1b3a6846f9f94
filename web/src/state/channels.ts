// SPDX-License-Identifier: Apache-2.0
// The curves of a session: their numbers in the history, names and units.
import type { Tick } from "../gen/phalanx/tick_pb";
import { strings } from "../strings";
import { kSegments } from "../view3d/segments";

export const kDigits = 5;
export const kJoints = 20;
export const kJointsPerDigit = 4;
export const kSegmentsPerDigit = 3;

export type Quantity = "force_raw" | "force_sent" | "torque" | "angle_measured" | "angle_shown";

export interface Channel {
  readonly index: number; // in the history
  readonly quantity: Quantity;
  readonly part: number; // segment or joint
  readonly digit: number; // -1: the palm
  readonly place: number; // in the digit, from the palm
  readonly unit: string;
}

export const digitOfSegment = (segment: number) =>
  segment === kSegments - 1 ? -1 : Math.floor(segment / kSegmentsPerDigit);
export const digitOfJoint = (joint: number) => Math.floor(joint / kJointsPerDigit);

function list(): Channel[] {
  const channels: Channel[] = [];
  const add = (quantity: Quantity, count: number, unit: string, digit: (part: number) => number, places: number) => {
    for (let part = 0; part < count; ++part) {
      channels.push({ index: channels.length, quantity, part, digit: digit(part), place: part % places, unit });
    }
  };
  const units = strings.units;
  add("force_raw", kSegments, units.newton, digitOfSegment, kSegmentsPerDigit);
  add("force_sent", kSegments, units.newton, digitOfSegment, kSegmentsPerDigit);
  add("torque", kJoints, units.torque, digitOfJoint, kJointsPerDigit);
  add("angle_measured", kJoints, units.radian, digitOfJoint, kJointsPerDigit);
  add("angle_shown", kJoints, units.radian, digitOfJoint, kJointsPerDigit);
  return channels;
}

export const channels: readonly Channel[] = list();

export function channelsOf(quantity: Quantity): readonly Channel[] {
  return channels.filter((channel) => channel.quantity === quantity);
}

/// A tick as one row of the history, in the channels' order. What is missing is NaN.
export function fillRow(tick: Tick, row: Float64Array): void {
  const torque = 2 * kSegments;
  const measured = torque + kJoints;
  const shown = measured + kJoints;
  row.fill(0, 0, torque);
  for (const contact of tick.contact) {
    if (contact.segment >= kSegments) continue;
    row[contact.segment] = contact.forceRaw;
    row[kSegments + contact.segment] = tick.factor * contact.force;
  }
  for (let joint = 0; joint < kJoints; ++joint) {
    row[torque + joint] = tick.torque[joint] ?? NaN;
    row[measured + joint] = tick.hcpAngle[joint] ?? NaN;
    row[shown + joint] = tick.gdpAngle[joint] ?? NaN;
  }
}

/// What a digit's contacts push with together: the sum of what is sent for its segments [N].
export function digitForces(tick: Tick | undefined): number[] {
  const forces = new Array<number>(kDigits).fill(0);
  for (const contact of tick?.contact ?? []) {
    const digit = digitOfSegment(contact.segment);
    if (digit >= 0 && digit < kDigits) forces[digit]! += (tick?.factor ?? 0) * contact.force;
  }
  return forces;
}
