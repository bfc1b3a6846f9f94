// SPDX-License-Identifier: Apache-2.0
// Outline of a drawn hand as its owner sees the own palm: circles along each digit, from the flexion of each digit. Coordinates are those
// of a right hand in a picture of 400 by 460; a left hand is its mirror image.

export const kHandWidth = 400;
export const kHandHeight = 460;

/// Pose of a drawn hand.
export interface HandPose {
  readonly flexion: readonly number[]; // of thumb to little finger, 0 (open) .. 1 (closed)
  readonly oppose?: { readonly finger: number; readonly amount: number } | undefined; // the thumb goes to this finger's tip, 0 .. 1; 1: it touches
}

export interface Bead {
  readonly x: number;
  readonly y: number;
  readonly r: number;
}

/// A digit: circles at its joints and at its tip, whose hull is its outline. The first one is the base.
export interface DigitShape {
  readonly beads: readonly Bead[];
  readonly turned: readonly number[]; // of each segment: cosine of its angle out of the picture; 1 lies in it, -1 points back
}

const kDegree = Math.PI / 180;

interface FingerForm {
  readonly x: number;
  readonly y: number;
  readonly lean: number; // [rad] to the thumb's side
  readonly lengths: readonly [number, number, number];
  readonly radius: number;
  readonly touching: number; // flexion at which the thumb meets its tip
}

const fingers: readonly FingerForm[] = [
  { x: 258, y: 232, lean: 9 * kDegree, lengths: [68, 46, 34], radius: 22, touching: 0.55 },
  { x: 210, y: 218, lean: 1 * kDegree, lengths: [76, 52, 36], radius: 23, touching: 0.62 },
  { x: 163, y: 228, lean: -7 * kDegree, lengths: [70, 48, 34], radius: 21.5, touching: 0.7 },
  { x: 121, y: 256, lean: -17 * kDegree, lengths: [52, 34, 28], radius: 18, touching: 0.78 },
];
const kBends = [82 * kDegree, 96 * kDegree, 58 * kDegree]; // of MCP, PIP and DIP joint in the closed hand
const kTaper = [1, 0.95, 0.88, 0.76];
const kThumbBase = { x: 262, y: 386 };
const kThumbLengths = [86, 62, 44] as const;
const kThumbRadii = [40, 30, 25, 20] as const;
const kThumbOpen = [42 * kDegree, 30 * kDegree, 24 * kDegree]; // from upright to the thumb's side
const kThumbClosed = [14 * kDegree, -42 * kDegree, -72 * kDegree];

const bounded = (share: number | undefined) => Math.min(1, Math.max(0, Number.isFinite(share) ? share! : 0));
const mix = (a: number, b: number, share: number) => a + (b - a) * share;

function fingerShape(form: FingerForm, flexion: number): DigitShape {
  const beads: Bead[] = [{ x: form.x, y: form.y, r: form.radius }];
  const turned: number[] = [];
  let angle = 0;
  let { x, y } = form;
  for (let segment = 0; segment < 3; ++segment) {
    angle += kBends[segment]! * flexion;
    const along = form.lengths[segment]! * Math.cos(angle);
    const nearer = 1 + 0.12 * Math.max(0, Math.sin(Math.min(angle, 110 * kDegree)));
    x += along * Math.sin(form.lean);
    y -= along * Math.cos(form.lean);
    beads.push({ x, y, r: form.radius * kTaper[segment + 1]! * nearer });
    turned.push(Math.cos(angle));
  }
  return { beads, turned };
}

function thumbJoints(flexion: number): { x: number; y: number }[] {
  const joints = [{ ...kThumbBase }];
  for (let segment = 0; segment < 3; ++segment) {
    const angle = mix(kThumbOpen[segment]!, kThumbClosed[segment]!, flexion);
    const before = joints[segment]!;
    joints.push({ x: before.x + kThumbLengths[segment]! * Math.sin(angle), y: before.y - kThumbLengths[segment]! * Math.cos(angle) });
  }
  return joints;
}

/// Joints of a thumb whose tip is at a place: two segments of fixed length where they reach it, longer ones where they do not.
function thumbJointsTo(tip: { x: number; y: number }, finger: number): { x: number; y: number }[] {
  const angle = mix(16, -34, (finger - 1) / 3) * kDegree;
  const base = { ...kThumbBase };
  const mcp = { x: base.x + kThumbLengths[0] * Math.sin(angle), y: base.y - kThumbLengths[0] * Math.cos(angle) };
  const dx = tip.x - mcp.x;
  const dy = tip.y - mcp.y;
  const distance = Math.max(1, Math.hypot(dx, dy));
  const stretch = Math.max(1, distance / (0.985 * (kThumbLengths[1] + kThumbLengths[2])));
  const a = kThumbLengths[1] * stretch;
  const b = kThumbLengths[2] * stretch;
  const cosine = Math.min(1, Math.max(-1, (a * a + distance * distance - b * b) / (2 * a * distance)));
  const heading = Math.atan2(dx, -dy) + Math.acos(cosine); // bends to the outer side
  return [base, mcp, { x: mcp.x + a * Math.sin(heading), y: mcp.y - a * Math.cos(heading) }, { ...tip }];
}

/// Digits of a right hand, thumb first. A number that is not finite counts as open.
export function handShape(pose: HandPose): readonly DigitShape[] {
  const oppose = pose.oppose && pose.oppose.finger >= 1 && pose.oppose.finger <= 4 ? pose.oppose : undefined;
  const amount = bounded(oppose?.amount);
  const shapes: DigitShape[] = fingers.map((form, index) => {
    const own = bounded(pose.flexion[index + 1]);
    return fingerShape(form, oppose?.finger === index + 1 ? mix(own, form.touching, amount) : own);
  });
  let joints = thumbJoints(bounded(pose.flexion[0]));
  if (oppose) {
    const tip = shapes[oppose.finger - 1]!.beads[3]!;
    const touching = thumbJointsTo({ x: tip.x + 8, y: tip.y + 12 }, oppose.finger);
    joints = joints.map((joint, index) => ({ x: mix(joint.x, touching[index]!.x, amount), y: mix(joint.y, touching[index]!.y, amount) }));
  }
  const thumb = { beads: joints.map((joint, index) => ({ ...joint, r: kThumbRadii[index]! })), turned: [1, 1, 1] };
  return [thumb, ...shapes];
}

/// Path of the hull of two circles.
function capsule(a: Bead, b: Bead): string {
  const dx = b.x - a.x;
  const dy = b.y - a.y;
  const distance = Math.hypot(dx, dy);
  if (distance <= Math.abs(a.r - b.r) + 1e-6) return circle(a.r >= b.r ? a : b);
  const heading = Math.atan2(dy, dx);
  const open = Math.acos((a.r - b.r) / distance);
  const at = ({ x, y, r }: Bead, angle: number) => `${(x + r * Math.cos(angle)).toFixed(2)} ${(y + r * Math.sin(angle)).toFixed(2)}`;
  const arc = (r: number, large: boolean, to: string) => `A${r.toFixed(2)} ${r.toFixed(2)} 0 ${large ? 1 : 0} 1 ${to}`;
  return `M${at(a, heading + open)}${arc(a.r, open < Math.PI / 2, at(a, heading - open))}L${at(b, heading - open)}${arc(b.r, open > Math.PI / 2, at(b, heading + open))}Z`;
}

function circle({ x, y, r }: Bead): string {
  return `M${(x - r).toFixed(2)} ${y.toFixed(2)}a${r.toFixed(2)} ${r.toFixed(2)} 0 1 1 ${(2 * r).toFixed(2)} 0a${r.toFixed(2)} ${r.toFixed(2)} 0 1 1 ${(-2 * r).toFixed(2)} 0Z`;
}

/// Path of a digit's outline, from one of its circles on.
export function digitPath(shape: DigitShape, from = 0): string {
  let path = "";
  for (let at = from; at + 1 < shape.beads.length; ++at) path += capsule(shape.beads[at]!, shape.beads[at + 1]!);
  return path;
}

/// Path of the palm and the wrist.
export const kPalmPath =
  "M122 238C132 226 146 210 170 206C196 196 226 198 246 206C268 212 282 226 284 246C288 282 302 316 292 352C284 386 262 404 256 430L254 462L146 462L144 428C132 398 108 360 102 318C98 286 104 256 122 238Z";
/// Lines of the palm.
export const kPalmLines = "M112 292C146 276 196 282 246 262M118 322C160 316 206 308 270 290M276 288C236 296 206 336 210 408";
