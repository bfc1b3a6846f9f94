// SPDX-License-Identifier: Apache-2.0
// The curves of a session: their numbers in the history, names and units.
import type { Tick } from "../gen/phalanx/tick_pb";
import { strings } from "../strings";
import { kPalm, kSegments, kSegmentsPerDigit } from "../view3d/segments";
import type { Shown } from "./shown";
import { verdictKinds, verdictOf } from "./verdict";

export const kDigits = 5;
export const kJoints = 20;
export const kJointsPerDigit = 4;

/// factor: of the station on the torques, 0 where nothing is sent. verdict: number in verdictKinds. circumstances: number in Shown's.
export type Quantity =
  | "force_raw"
  | "force_sent"
  | "torque"
  | "angle_measured"
  | "angle_shown"
  | "stiffness"
  | "digit_force"
  | "factor"
  | "verdict"
  | "circumstances";

export interface Channel {
  readonly index: number; // in the history
  readonly quantity: Quantity;
  readonly part: number; // segment, joint or digit; 0: there is but one
  readonly digit: number; // -1: the palm, or the whole hand
  readonly place: number; // in the digit, from the palm
  readonly unit: string; // empty: none
}

export const digitOfSegment = (segment: number) => (segment === kPalm ? -1 : Math.floor(segment / kSegmentsPerDigit));
export const digitOfJoint = (joint: number) => Math.floor(joint / kJointsPerDigit);

function list(): Channel[] {
  const channels: Channel[] = [];
  const add = (quantity: Quantity, count: number, unit: string, digit: (part: number) => number, places: number) => {
    for (let part = 0; part < count; ++part) {
      channels.push({ index: channels.length, quantity, part, digit: digit(part), place: part % places, unit });
    }
  };
  const units = strings.units;
  const hand = () => -1;
  add("force_raw", kSegments, units.newton, digitOfSegment, kSegmentsPerDigit);
  add("force_sent", kSegments, units.newton, digitOfSegment, kSegmentsPerDigit);
  add("torque", kJoints, units.torque, digitOfJoint, kJointsPerDigit);
  add("angle_measured", kJoints, units.radian, digitOfJoint, kJointsPerDigit);
  add("angle_shown", kJoints, units.radian, digitOfJoint, kJointsPerDigit);
  add("stiffness", 1, units.newtonPerMetre, hand, 1);
  add("digit_force", kDigits, units.newton, (digit) => digit, 1);
  add("factor", 1, "", hand, 1);
  add("verdict", 1, "", hand, 1);
  add("circumstances", 1, "", hand, 1);
  return channels;
}

export const channels: readonly Channel[] = list();

export function channelsOf(quantity: Quantity): readonly Channel[] {
  return channels.filter((channel) => channel.quantity === quantity);
}

const kSampleStale = 1 << 12; // Status::kSampleStale

/// Whether the step was made from what the device has just measured: one that is silent has its last sample used again.
export const isMeasured = (tick: Tick) => (tick.status & kSampleStale) === 0;

/// A tick as one row of the history, in the channels' order. What is missing, or not measured, is NaN.
/// @param circumstances  their number; NaN: not known
export function fillRow(tick: Tick, row: Float64Array, circumstances = NaN): void {
  const torque = 2 * kSegments;
  const measured = torque + kJoints;
  const shown = measured + kJoints;
  row.fill(0, 0, torque);
  for (const contact of tick.contact) {
    if (contact.segment >= kSegments) continue;
    row[contact.segment] = contact.forceRaw;
    row[kSegments + contact.segment] = tick.factor * contact.force;
  }
  const now = isMeasured(tick);
  for (let joint = 0; joint < kJoints; ++joint) {
    row[torque + joint] = tick.torque[joint] ?? NaN;
    row[measured + joint] = (now ? tick.hcpAngle[joint] : undefined) ?? NaN;
    row[shown + joint] = (now ? tick.gdpAngle[joint] : undefined) ?? NaN;
  }
  const stiffness = shown + kJoints;
  row[stiffness] = tick.stiffness;
  row.set(digitForces(tick), stiffness + 1);
  const withheld = tick.atRest && tick.contact.some((contact) => contact.forceRaw > 0); // without contact there is nothing to send
  row.set([withheld ? 0 : tick.factor, verdictKinds.indexOf(verdictOf(tick).kind), circumstances], stiffness + 1 + kDigits);
}

/// @returns for each digit the length of the vector sum of the forces on its segments, which the station limits [N]
export function digitForces(tick: Tick | undefined): number[] {
  const sums = Array.from({ length: kDigits }, () => [0, 0, 0] as [number, number, number]);
  for (const contact of tick?.contact ?? []) {
    const sum = sums[digitOfSegment(contact.segment)];
    if (!sum) continue;
    for (const axis of [0, 1, 2] as const) sum[axis] += (tick?.factor ?? 0) * contact.force * (contact.normal[axis] ?? 0);
  }
  return sums.map((sum) => Math.hypot(...sum));
}

/// Digits of which the device measures no joint: they follow others, and nothing pushes them back.
export function followers(sensedJoints: readonly number[]): boolean[] {
  const own = new Set(sensedJoints.map(digitOfJoint));
  return Array.from({ length: kDigits }, (_, digit) => !own.has(digit));
}

/// Digits whose force is computed and not felt: followers, and all of a device that renders no torque.
export function notFelt({ sensedJoint, rendersTorque }: Pick<Shown, "sensedJoint" | "rendersTorque">): boolean[] {
  return followers(sensedJoint).map((follows) => follows || !rendersTorque);
}
