// SPDX-License-Identifier: Apache-2.0
// What the plots show: which channels each has, how they are drawn and named.
import { mixed } from "../colour";
import { channelsOf, kDigits, type Channel, type Quantity } from "../state/channels";
import { strings } from "../strings";
import { digitColours, themes, type ThemeName } from "../theme";

/// digits: the force of each digit. segments, joints: of one digit.
export type PlotSubject = "digits" | "segments" | "joints";
export const plotSubjects: readonly PlotSubject[] = ["digits", "segments", "joints"];

/// One plot has one unit.
export type PlotKind = "force" | "segment" | "torque" | "angle";

export const kindsOf: Readonly<Record<PlotSubject, readonly PlotKind[]>> = {
  digits: ["force"],
  segments: ["segment"],
  joints: ["torque", "angle"],
};

/// What a person has chosen to see.
export interface PlotChoice {
  readonly subject: PlotSubject;
  readonly digits: readonly boolean[]; // of the subject "digits"
  readonly digit: number; // of the others
  readonly computed: readonly boolean[]; // digits that follow others: the device neither measures nor moves them
}

export const firstChoice: PlotChoice = {
  subject: "digits",
  digits: new Array<boolean>(kDigits).fill(true),
  digit: 1,
  computed: new Array<boolean>(kDigits).fill(false),
};

/// Forces are drawn only where they are not zero.
export const isForce = (kind: PlotKind) => kind === "force" || kind === "segment";

const quantities: Readonly<Record<PlotKind, readonly Quantity[]>> = {
  force: ["digit_force"],
  segment: ["force_sent", "force_raw"],
  torque: ["torque"],
  angle: ["angle_shown", "angle_measured"],
};

/// What goes in, before what comes out of it: drawn thin.
const inputs = new Set<Quantity>(["force_raw", "angle_measured"]);

export interface Curve {
  readonly channel: Channel;
  readonly colour: string;
  readonly width: number;
  readonly dash: readonly number[];
  readonly label: string; // that is understood alone
  readonly short: string; // at the curve's end; empty: it has the name of the thick one beside it
  readonly letter: string; // there, where the plot is narrow; empty: its dashes tell it
  readonly scale: number; // factor from the stored to the displayed value: degrees
}

const kThick = 2.75;
const kThin = 1.25;
const computedDash: readonly number[] = [5, 4];
/// Parts of one digit have its colour in shades from its own to the text's, and dashes of their own.
const kShades: readonly number[] = [0, 0.35, 0.6, 0.8];
const segmentOrder: readonly number[] = [2, 1, 0]; // the tip has the digit's own colour
const partDash: readonly (readonly number[])[] = [[], [10, 3], [4, 3], [10, 3, 3, 3]];

const digitName = (digit: number, computed: boolean) => {
  const name = strings.digits[digit] ?? "";
  return computed ? strings.plots.computed(name) : name;
};

function partCurve(channel: Channel, theme: ThemeName): Curve {
  const words = strings.plots;
  const ofForce = channel.quantity.startsWith("force");
  const joints = channel.digit === 0 ? strings.hand.joints.thumb : strings.hand.joints.finger;
  const part = (ofForce ? words.segments : joints)[channel.place] ?? "";
  const suffixes: Readonly<Partial<Record<Quantity, string>>> = {
    force_raw: words.raw,
    force_sent: words.sent,
    angle_measured: words.measured,
    angle_shown: words.shown,
  };
  const suffix = suffixes[channel.quantity] ?? "";
  const input = inputs.has(channel.quantity);
  const rank = ofForce ? segmentOrder[channel.place]! : channel.place;
  const colour = digitColours[theme][channel.digit] ?? "";
  return {
    channel,
    colour: mixed(colour, themes[theme].text, kShades[rank] ?? 0),
    width: input ? kThin : kThick,
    dash: partDash[rank] ?? [],
    label: words.curve(strings.digits[channel.digit] ?? "", part, suffix),
    short: input ? "" : part,
    letter: "",
    scale: channel.quantity.startsWith("angle") ? 180 / Math.PI : 1,
  };
}

export function curvesOf(kind: PlotKind, choice: PlotChoice, theme: ThemeName): readonly Curve[] {
  const all = quantities[kind].flatMap(channelsOf);
  if (kind !== "force") return all.filter(({ digit }) => digit === choice.digit).map((channel) => partCurve(channel, theme));
  return all
    .filter(({ digit }) => choice.digits[digit] ?? false)
    .map((channel) => {
      const computed = choice.computed[channel.digit] ?? false;
      const name = digitName(channel.digit, computed);
      const style = computed ? { width: kThin, dash: computedDash } : { width: kThick, dash: [] };
      return { channel, colour: digitColours[theme][channel.digit] ?? "", ...style, label: name, short: name, letter: strings.digitLetters[channel.digit] ?? "", scale: 1 };
    });
}

/// "Force on the segments of the index finger", without the unit.
export function titleOf(kind: PlotKind, choice: PlotChoice): string {
  const title = strings.plots.titles[kind];
  return typeof title === "string" ? title : title(digitName(choice.digit, choice.computed[choice.digit] ?? false));
}

/// What thick and thin lines mean; empty: there are no others.
export function linesOf(kind: PlotKind): string {
  if (kind === "segment") return strings.plots.segmentLines;
  return kind === "angle" ? strings.plots.angleLines : "";
}

export const unitOf = (kind: PlotKind): string => strings.plots.units[kind];
export const axisOf = (kind: PlotKind): string => strings.plots.axis(strings.plots.axes[kind], unitOf(kind));

/// A channel's name in files: "force_sent index-finger-phalanx-distal".
export function columnName(channel: Channel, segments: readonly string[], joints: readonly string[]): string {
  const { quantity, part } = channel;
  if (quantity === "digit_force") return `${quantity} ${strings.plots.csvDigits[part] ?? part}`;
  if (quantity.startsWith("force")) return `${quantity} ${segments[part] ?? `segment_${part}`}`;
  if (quantity === "torque" || quantity.startsWith("angle")) return `${quantity} ${joints[part] ?? `joint_${part}`}`;
  return quantity;
}
