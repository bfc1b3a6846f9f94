// SPDX-License-Identifier: Apache-2.0
// The drawn hand: shows a movement without words, and mirrors the patient's own movement. Instructed digits have a thicker line and a dot
// beside the colour, so that they are seen without it.
import type { Demonstration as ShownHand, ExerciseNow } from "./game";
import { digitPath, handShape, kHandHeight, kHandWidth, kPalmLines, kPalmPath, type HandPose } from "./hand_shape";

const kNamespace = "http://www.w3.org/2000/svg";

export function svg(tag: string, attributes: Readonly<Record<string, string | number>> = {}): SVGElement {
  const element = document.createElementNS(kNamespace, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

const write = (element: Element, name: string, value: string) => {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
};

const kLine = 5; // width of an outline

/// A hand with five digits. The style sheet may set --hand-fill, --hand-line and --hand-mark.
export class DrawnHand {
  readonly element: SVGSVGElement;
  private readonly digits: { readonly group: SVGElement; readonly outline: SVGElement; readonly blend: SVGElement; readonly over: SVGElement; readonly fill: SVGElement; readonly details: SVGElement; readonly mark: SVGElement; readonly nail: SVGElement; readonly dot: SVGElement }[] = [];
  private readonly ball: SVGElement;
  private readonly rays: SVGElement;
  private marked: readonly number[] = [];

  /// @param side  "left" or "right"; anything else is a right hand
  constructor(side: string, label = "") {
    this.element = svg("svg", { viewBox: `-6 -6 ${kHandWidth + 12} ${kHandHeight + 4}`, class: "drawn-hand" }) as SVGSVGElement;
    if (label) {
      this.element.setAttribute("role", "img");
      this.element.setAttribute("aria-label", label);
    } else this.element.setAttribute("aria-hidden", "true");
    const fill = "var(--hand-fill, #fbf3e6)";
    const line = "var(--hand-line, #2b3a4f)";
    const root = svg("g", side === "left" ? { transform: `translate(${kHandWidth} 0) scale(-1 1)` } : {});
    const palm = svg("path", { d: kPalmPath, fill, stroke: line, "stroke-width": kLine, "stroke-linejoin": "round" });
    root.append(palm, svg("path", { d: kPalmLines, fill: "none", stroke: line, "stroke-width": 2.5, "stroke-linecap": "round", opacity: 0.35 }));
    this.ball = svg("g", { visibility: "hidden" });
    this.ball.append(svg("ellipse", { rx: 38, ry: 38, fill: "var(--hand-ball, #8fb8c9)", stroke: line, "stroke-width": 4 }), svg("ellipse", { cx: -12, cy: -12, rx: 9, ry: 7, fill: "#fff", opacity: 0.6 }));
    root.append(this.ball);
    for (const digit of [1, 2, 3, 4, 0]) {
      const group = svg("g", { "data-digit-of-hand": digit });
      const outline = svg("path", { fill: line, stroke: line, "stroke-width": kLine * 2, "stroke-linejoin": "round" });
      const blend = svg("path", { fill });
      const over = svg("path", { fill: line, stroke: line, "stroke-width": kLine * 2, "stroke-linejoin": "round" });
      const inner = svg("path", { fill });
      const mark = svg("path", { fill: "var(--hand-mark, #f4b942)", visibility: "hidden" });
      const details = svg("path", { fill: "none", stroke: line, "stroke-width": 2.5, "stroke-linecap": "round", opacity: 0.4 });
      const nail = svg("ellipse", { fill: "#fff", stroke: line, "stroke-width": 2, opacity: 0.75 });
      const dot = svg("circle", { r: 8, fill: line, visibility: "hidden" });
      group.append(outline, blend, over, inner, mark, details, nail, dot);
      root.append(group);
      this.digits[digit] = { group, outline, blend, over, fill: inner, mark, details, nail, dot };
    }
    this.rays = svg("path", { fill: "none", stroke: line, "stroke-width": 5, "stroke-linecap": "round", visibility: "hidden" });
    root.append(this.rays);
    this.element.append(root);
    this.pose({ flexion: [0, 0, 0, 0, 0] });
  }

  /// Marks the instructed digits.
  mark(digits: readonly number[]): void {
    if (digits.length === this.marked.length && digits.every((digit, at) => this.marked[at] === digit)) return;
    this.marked = [...digits];
    this.digits.forEach(({ group, outline, over, mark, dot }, digit) => {
      const on = digits.includes(digit);
      write(group, "data-marked", String(on));
      write(mark, "visibility", on ? "visible" : "hidden");
      for (const path of [outline, over]) write(path, "stroke-width", String(on ? kLine * 2.8 : kLine * 2));
      write(dot, "visibility", on ? "visible" : "hidden");
    });
    // A marked finger lies on the ball, the others behind it; a whole hand lies around it.
    const order = [1, 2, 3, 4].sort((a, b) => Number(digits.includes(a)) - Number(digits.includes(b)));
    const ballFirst = !digits.some((digit) => digit > 0);
    const root = this.ball.parentNode!;
    const above = [...order.filter((digit) => !digits.includes(digit)).map((digit) => this.digits[digit]!.group)];
    const rest = [...order.filter((digit) => digits.includes(digit)), 0].map((digit) => this.digits[digit]!.group);
    for (const part of ballFirst ? [this.ball, ...above, ...rest] : [...above, this.ball, ...rest]) root.insertBefore(part, this.rays);
  }

  /// @param press  0 .. 1: a ball is pressed that strongly by the marked digits; absent: no ball
  pose(pose: HandPose, press?: number): void {
    const shapes = handShape(pose);
    shapes.forEach((shape, digit) => {
      const parts = this.digits[digit]!;
      const [base, second] = shape.beads as [(typeof shape.beads)[number], (typeof shape.beads)[number]];
      const tip = shape.beads[3]!;
      const beside = shape.beads[2]!;
      write(parts.outline, "d", digitPath({ ...shape, beads: shape.beads.slice(0, 2) }));
      const r = base.r + kLine * 0.2;
      const thumb = digit === 0;
      write(parts.blend, "d", thumb
        ? `M${base.x - r - 8} ${base.y - 50}h${r * 1.2}v${r + 60}h${-r * 1.2 - 8}Z`
        : `M${base.x - r} ${base.y - 2}h${2 * r}l-4 ${r + 16}h${8 - 2 * r}Z`);
      write(parts.over, "d", digitPath(shape, 1));
      write(parts.fill, "d", digitPath(shape));
      write(parts.mark, "d", digitPath(shape, thumb ? 1 : 0));
      // Creases at the joints that are seen from their inner side.
      let creases = "";
      for (const joint of [1, 2]) {
        if ((shape.turned[joint] ?? 1) < 0.5) continue;
        const bead = shape.beads[joint]!;
        const next = shape.beads[joint + 1]!;
        const length = Math.max(1, Math.hypot(next.x - bead.x, next.y - bead.y));
        const nx = -(next.y - bead.y) / length;
        const ny = (next.x - bead.x) / length;
        const w = bead.r * 0.62;
        creases += `M${(bead.x - nx * w).toFixed(1)} ${(bead.y - ny * w).toFixed(1)}Q${(bead.x + ((next.x - bead.x) / length) * -5).toFixed(1)} ${(bead.y + ((next.y - bead.y) / length) * -5).toFixed(1)} ${(bead.x + nx * w).toFixed(1)} ${(bead.y + ny * w).toFixed(1)}`;
      }
      write(parts.details, "d", creases);
      const back = !thumb && (shape.turned[2] ?? 1) < -0.25;
      write(parts.nail, "visibility", back ? "visible" : "hidden");
      if (back) {
        const angle = (Math.atan2(tip.y - beside.y, tip.x - beside.x) * 180) / Math.PI;
        write(parts.nail, "transform", `translate(${tip.x.toFixed(1)} ${tip.y.toFixed(1)}) rotate(${angle.toFixed(1)})`);
        write(parts.nail, "rx", (tip.r * 0.62).toFixed(1));
        write(parts.nail, "ry", (tip.r * 0.55).toFixed(1));
      }
      write(parts.dot, "cx", mid(second.x, beside.x));
      write(parts.dot, "cy", mid(second.y, beside.y));
    });
    this.showBall(shapes, press);
  }

  private showBall(shapes: ReturnType<typeof handShape>, press: number | undefined): void {
    write(this.ball, "visibility", press === undefined ? "hidden" : "visible");
    write(this.rays, "visibility", press !== undefined && press > 0.35 ? "visible" : "hidden");
    if (press === undefined) return;
    const finger = shapes[this.marked.find((digit) => digit > 0) ?? 1]!.beads[3]!;
    const thumb = this.marked.includes(0) ? shapes[0]!.beads[3]! : null;
    const x = thumb ? (finger.x + thumb.x) / 2 + 6 : finger.x;
    const y = thumb ? (finger.y + thumb.y) / 2 : finger.y + finger.r * 0.5 + (this.marked.length > 0 ? 22 : 40);
    write(this.ball, "transform", `translate(${x.toFixed(1)} ${y.toFixed(1)}) scale(${(1 + 0.16 * press).toFixed(3)} ${(1 - 0.22 * press).toFixed(3)})`);
    let rays = "";
    for (const side of [-1, 1]) for (let ring = 0; ring < Math.round(press * 2); ++ring) rays += `M${x + side * (58 + 14 * ring)} ${y - 16 - 5 * ring}q${side * 8} ${16 + 5 * ring} 0 ${32 + 10 * ring}`;
    write(this.rays, "d", rays);
  }
}

const mid = (a: number, b: number) => ((a + b) / 2).toFixed(1);

/// Movement that a drawn hand can show.
export type Movement = "open" | "close" | "open_close" | "press" | "squeeze" | "let_go" | "touch" | "one_finger" | "straighten" | "pinch" | "bend" | "explore" | "grasp" | "rest";

/// What is to be done, for the drawn hand.
export interface Demonstrated {
  readonly movement: Movement;
  readonly digits: readonly number[];
}

/// Movement of what the exercise asks for now; outside of trials that of the measure. It reads only what has been instructed, never the
/// hand or its forces.
export function demonstrated(exercise: Pick<ExerciseNow, "measure" | "target">): Demonstrated {
  const { digits, kind } = exercise.target;
  const finger = digits.length > 0 ? digits : [1];
  switch (exercise.measure) {
    case "press_and_hold":
    case "force_tracking":
      return { movement: "press", digits: finger };
    case "own_force":
      return { movement: "squeeze", digits };
    case "squeeze_release":
      return { movement: kind === "open" ? "let_go" : "squeeze", digits: finger };
    case "pinch":
      return { movement: "pinch", digits: digits.length > 1 ? digits : [0, 1] };
    case "opposition":
      return { movement: "touch", digits: digits.length > 1 ? digits : [0, 1] };
    case "independence":
      return { movement: kind === "open" ? "straighten" : "one_finger", digits: finger };
    case "smoothness":
      return { movement: "bend", digits: finger };
    case "feel_and_find":
      return { movement: "explore", digits: finger };
    case "object_in_hand":
      return { movement: "grasp", digits: [] };
    default:
      return { movement: kind === "open" ? "open" : kind === "close" ? "close" : "open_close", digits: [] };
  }
}

const kCycle: Readonly<Record<Movement, number>> = { // [s]
  open: 4, close: 4, open_close: 6, press: 5, squeeze: 4, let_go: 4, touch: 4.5, one_finger: 5, straighten: 5, pinch: 5, bend: 4, explore: 5, grasp: 5, rest: 6,
};

/// 0 .. 1 .. 0 in a cycle, with rests at both ends.
export function wave(share: number): number {
  const s = share - Math.floor(share);
  const ramp = (x: number) => { const c = Math.min(1, Math.max(0, x)); return c * c * (3 - 2 * c); };
  return s < 0.5 ? ramp((s - 0.08) / 0.3) : 1 - ramp((s - 0.62) / 0.3);
}

/// The pose of a movement at a time of its cycle, and how strongly a ball is pressed, if there is one.
export function demonstratedPose({ movement, digits }: Demonstrated, seconds: number): { pose: HandPose; press: number | undefined } {
  const share = (seconds / kCycle[movement]) % 1;
  const w = wave(share);
  const all = (value: number) => [value * 0.9, value, value, value, value];
  const only = (value: number, rest: number) => [0, 1, 2, 3, 4].map((digit) => (digits.includes(digit) ? value : rest));
  switch (movement) {
    case "open": return { pose: { flexion: all(0.85 * (1 - w)) }, press: undefined };
    case "close": return { pose: { flexion: all(w) }, press: undefined };
    case "open_close": return { pose: { flexion: all(w) }, press: undefined };
    case "press": return { pose: { flexion: only(0.3 + 0.14 * w, 0.06) }, press: w };
    case "explore": return { pose: { flexion: only(0.3 + 0.14 * w, 0.06) }, press: w };
    case "squeeze": return { pose: { flexion: digits.length > 0 && digits.length < 5 ? only(0.3 + 0.16 * w, 0.08) : all(0.42 + 0.22 * w) }, press: w };
    case "let_go": return { pose: { flexion: digits.length > 0 && digits.length < 5 ? only(0.46 - 0.46 * w, 0.08 - 0.06 * w) : all(0.62 * (1 - w)) }, press: 1 - w };
    case "touch": return { pose: { flexion: all(0.04), oppose: { finger: digits.find((digit) => digit > 0) ?? 1, amount: w } }, press: undefined };
    case "pinch": return { pose: { flexion: all(0.1), oppose: { finger: digits.find((digit) => digit > 0) ?? 1, amount: 0.66 + 0.12 * w } }, press: w };
    case "one_finger": return { pose: { flexion: only(0.85 * w, 0.03) }, press: undefined };
    case "straighten": return { pose: { flexion: only(0.85 * (1 - w), 0.03) }, press: undefined };
    case "bend": return { pose: { flexion: only(0.7 * w, 0.05) }, press: undefined };
    case "grasp": return { pose: { flexion: all(0.1 + 0.42 * w) }, press: undefined };
    case "rest": return { pose: { flexion: all(0.14 + 0.03 * w) }, press: undefined };
  }
}

/// The drawn hand in the frame of the page. While the scene is hidden it never shows the patient's own hand.
class DemonstratingHand implements ShownHand {
  readonly element: HTMLElement;
  private readonly calm: () => boolean;
  private hand: DrawnHand | undefined;
  private side = "";
  private seconds = 0;
  private shown: Demonstrated = { movement: "rest", digits: [] };

  constructor(calm: () => boolean) {
    this.calm = calm;
    this.element = document.createElement("div");
    this.element.className = "demonstration";
    this.element.style.cssText = "width:100%;height:100%";
  }

  show(exercise: ExerciseNow, dt: number, own: boolean): void {
    const hand = this.handOf(exercise.side);
    const what = demonstrated(exercise);
    if (!same(what, this.shown)) {
      this.shown = what;
      this.seconds = 0;
    }
    hand.mark(what.digits);
    if (own && !exercise.hidesScene && exercise.flexion.length > 0) {
      hand.pose({ flexion: exercise.flexion, oppose: opposed(what, exercise.padDistance) });
      return;
    }
    if (dt > 0) this.seconds += Math.min(dt, 0.1);
    // With less motion it changes between begin and end, without what lies between.
    const cycle = kCycle[what.movement];
    const at = this.calm() ? ((this.seconds / cycle) % 1 < 0.5 ? 0 : cycle * 0.5) : this.seconds;
    const { pose, press } = demonstratedPose(what, at);
    hand.pose(pose, press);
  }

  private handOf(side: string): DrawnHand {
    if (this.hand && this.side === side) return this.hand;
    this.side = side;
    this.hand = new DrawnHand(side);
    this.hand.element.style.cssText = "width:100%;height:100%;display:block";
    this.element.replaceChildren(this.hand.element);
    return this.hand;
  }
}

const same = (a: Demonstrated, b: Demonstrated) => a.movement === b.movement && a.digits.length === b.digits.length && a.digits.every((digit, at) => digit === b.digits[at]);

const kApart = 0.08; // distance of two pads from which on the thumb is drawn at rest [m]
const kTogether = 0.012; // distance of two pads that touch [m]

/// Way of the drawn thumb to the instructed finger.
export function opposed({ movement, digits }: Demonstrated, padDistance: readonly number[]): HandPose["oppose"] {
  const finger = digits.find((digit) => digit > 0);
  const distance = finger === undefined ? undefined : padDistance[finger - 1];
  if ((movement !== "touch" && movement !== "pinch") || finger === undefined || distance === undefined || !Number.isFinite(distance)) return undefined;
  return { finger, amount: Math.min(1, Math.max(0, (kApart - distance) / (kApart - kTogether))) };
}

/// @param calm  reduced motion is wanted now
export function makeDemonstration(calm: () => boolean = () => false): ShownHand {
  return new DemonstratingHand(calm);
}
