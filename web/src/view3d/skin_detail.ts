// SPDX-License-Identifier: Apache-2.0
// What the skin looks like where: worked out once from its bind pose. Segments' frames are WebXR's: fingers to -z, the back to +y.
import { Matrix4, Vector3 } from "three";
import { kPalm, kSegments, kSegmentsPerDigit } from "./segments";

/// Numbers of a vertex: on the skin
///   phase along its digit: a flexion crease at each whole number but 0; the palm 1/2; along the thumb below 0
///   how much it looks to the palm's side, -1 (the back) .. 1
///   how red it is, 0 .. 1
///   0
/// and on a nail: place from its root (0) to its free edge (1), across (-1 .. 1), 0, 1.
export const kDetail = 4;

const kKnuckle = 0.008; // reach of a knuckle's redness [m]

/// Frames of the bind pose, their inverses, and how far each segment reaches from its origin to its end.
export interface BoundHand {
  readonly frames: readonly Matrix4[]; // X_BS
  readonly inverses: readonly Matrix4[];
  readonly lengths: readonly number[]; // [m]
}

/// @param owner  of each vertex: the segment that has most of it
export function boundHand(frames: readonly Matrix4[], position: ArrayLike<number>, owner: ArrayLike<number>): BoundHand {
  const inverses = frames.map((frame) => frame.clone().invert());
  const origins = frames.map((frame) => new Vector3().setFromMatrixPosition(frame));
  const tips = new Array<number>(kSegments).fill(0);
  const point = new Vector3();
  for (let i = 0; i < owner.length; ++i) {
    const segment = owner[i]!;
    point.fromArray(position, 3 * i).applyMatrix4(inverses[segment]!);
    tips[segment] = Math.max(tips[segment]!, -point.z);
  }
  const lengths = tips.map((tip, segment) => {
    const next = origins[segment + 1];
    return isTip(segment) || segment === kPalm || !next ? Math.max(tip, 1e-3) : Math.max(next.distanceTo(origins[segment]!), 1e-3);
  });
  return { frames, inverses, lengths };
}

export function isTip(segment: number): boolean {
  return segment !== kPalm && segment % kSegmentsPerDigit === kSegmentsPerDigit - 1;
}

/// @returns kDetail numbers a vertex
export function skinDetail(hand: BoundHand, position: ArrayLike<number>, normal: ArrayLike<number>, owner: ArrayLike<number>): Float32Array {
  const detail = new Float32Array(kDetail * owner.length);
  const point = new Vector3();
  const outward = new Vector3();
  for (let i = 0; i < owner.length; ++i) {
    const segment = owner[i]!;
    point.fromArray(position, 3 * i).applyMatrix4(hand.inverses[segment]!);
    // The thumb's ball is part of the palm.
    outward.fromArray(normal, 3 * i).transformDirection(hand.inverses[segment === 0 ? kPalm : segment]!);
    const share = -point.z / hand.lengths[segment]!;
    detail[kDetail * i] = phaseAt(segment, share);
    detail[kDetail * i + 1] = -outward.y;
    detail[kDetail * i + 2] = rednessAt(segment, share, -point.z, hand.lengths[segment]!, outward.y);
  }
  return detail;
}

/// @param share  of the segment's length, from its origin
export function phaseAt(segment: number, share: number): number {
  if (segment === kPalm) return 0.5;
  const at = Math.min(1, Math.max(0, share));
  const part = segment % kSegmentsPerDigit;
  if (segment < kSegmentsPerDigit) return part === 0 ? -0.5 : part === 1 ? -0.5 - 0.5 * at : -1 - 0.49 * at;
  if (part === 0) return at < 0.5 ? 0.5 + at : 2 * at;
  return part + 1 + (isTip(segment) ? 0.49 : 1) * at; // at the segment's origin is the crease of that number
}

/// Tips of digits, and knuckles on the back.
function rednessAt(segment: number, share: number, along: number, length: number, back: number): number {
  if (segment === kPalm) return 0;
  const tip = isTip(segment) ? smooth((share - 0.25) / 0.6) : 0;
  const near = (away: number): number => Math.exp(-((away / kKnuckle) ** 2));
  const knuckle = near(along) + (isTip(segment) ? 0 : near(along - length));
  return Math.min(1, 0.85 * tip + 0.8 * Math.max(0, back) * knuckle);
}

function smooth(x: number): number {
  const t = Math.min(1, Math.max(0, x));
  return t * t * (3 - 2 * t);
}
