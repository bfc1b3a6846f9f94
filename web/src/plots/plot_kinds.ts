// SPDX-License-Identifier: Apache-2.0
// The three plots: which channels each shows, how they are drawn and named.
import { channelsOf, type Channel, type Quantity } from "../state/channels";
import { strings } from "../strings";
import { digitColours, type ThemeName } from "../theme";

export type PlotKind = "force" | "torque" | "angle";
export const plotKinds: readonly PlotKind[] = ["force", "torque", "angle"];

const quantities: Readonly<Record<PlotKind, readonly Quantity[]>> = {
  force: ["force_sent", "force_raw"],
  torque: ["torque"],
  angle: ["angle_shown", "angle_measured"],
};

/// Beneath it come those that are drawn thin: what goes in, before what comes out of it.
const thin = new Set<Quantity>(["force_raw", "angle_measured"]);

export interface Curve {
  readonly channel: Channel;
  readonly colour: string;
  readonly width: number;
  readonly dash: readonly number[];
  readonly label: string;
  readonly scale: number; // factor from the stored to the displayed value: degrees
}

const segmentDash: readonly (readonly number[])[] = [[2, 4], [8, 4], []];
const jointDash: readonly (readonly number[])[] = [[], [8, 3, 2, 3], [8, 4], [2, 4]];

function labelOf(channel: Channel, joint: boolean): string {
  const part = joint ? strings.hand.joints[channel.place] : strings.plots.segments[channel.place];
  const kinds: Readonly<Record<Quantity, string>> = {
    force_raw: strings.plots.raw,
    force_sent: strings.plots.sent,
    torque: "",
    angle_measured: strings.plots.measured,
    angle_shown: strings.plots.shown,
    stiffness: "",
  };
  return strings.plots.curve(strings.digits[channel.digit] ?? "", (part ?? "").toLowerCase(), kinds[channel.quantity]);
}

/// Curves of the digits that are chosen. The palm has no force of its own.
export function curvesOf(kind: PlotKind, digits: readonly boolean[], theme: ThemeName): readonly Curve[] {
  const joint = kind !== "force";
  return quantities[kind].flatMap((quantity) =>
    channelsOf(quantity)
      .filter((channel) => digits[channel.digit] ?? false)
      .map((channel) => ({
        channel,
        colour: digitColours[theme][channel.digit] ?? "",
        width: thin.has(quantity) ? 1 : 2,
        dash: (joint ? jointDash : segmentDash)[channel.place] ?? [],
        label: labelOf(channel, joint),
        scale: kind === "angle" ? 180 / Math.PI : 1,
      })),
  );
}

export const titleOf = (kind: PlotKind) => `${strings.plots.titles[kind]} [${strings.plots.units[kind]}]`;

export function legendOf(kind: PlotKind): string {
  const words = strings.plots;
  if (kind === "force") return `${words.lineSent}, ${words.lineRaw}; ${words.segmentLines}`;
  if (kind === "angle") return `${words.lineShown}, ${words.lineMeasured}; ${words.jointLines}`;
  return words.jointLines;
}

/// A channel's name in files: "force_sent index-finger-phalanx-distal".
export function columnName(channel: Channel, segments: readonly string[], joints: readonly string[]): string {
  if (channel.quantity === "stiffness") return channel.quantity;
  const force = channel.quantity.startsWith("force");
  const part = (force ? segments : joints)[channel.part] ?? `${force ? "segment" : "joint"}_${channel.part}`;
  return `${channel.quantity} ${part}`;
}
