// SPDX-License-Identifier: Apache-2.0
// What a figure states of the steps that it shows, each statement by itself.
import { savedMark } from "../panels/saving";
import { channelsOf } from "../state/channels";
import type { Circumstances } from "../state/circumstances";
import type { Shown } from "../state/shown";
import { strings } from "../strings";
import type { Span } from "./time_view";

const kMoment = { dateStyle: "medium", timeStyle: "medium", hourCycle: "h23" } as const;
const kDigits = 4; // of a stiffness: a history has single precision
const words = strings.plots.facts;
const numberChannel = channelsOf("circumstances")[0]!.index;
const stiffnessChannel = channelsOf("stiffness")[0]!.index;

interface InForce {
  readonly circumstances: readonly (Circumstances | undefined)[]; // each once, in the order of time; undefined: those of some steps are not known
  readonly stiffness: readonly [number, number]; // least and largest [N/m]; Infinity, -Infinity: there are no steps
}

function inForce({ history, circumstances }: Shown, { from, to }: Span): InForce {
  const time = history.time();
  const [numbers, stiffnesses] = [history.channel(numberChannel), history.channel(stiffnessChannel)];
  const found = new Set<number>();
  let [least, largest] = [Infinity, -Infinity];
  for (let i = history.firstFrom(from); i < time.length && time[i]! <= to; ++i) {
    const stiffness = stiffnesses[i]!;
    if (Number.isNaN(stiffness)) continue; // steps are missing here
    found.add(numbers[i]!);
    least = Math.min(least, stiffness);
    largest = Math.max(largest, stiffness);
  }
  return { circumstances: [...found].map((number) => circumstances[number]), stiffness: [least, largest] };
}

function stiffnessFact([least, largest]: InForce["stiffness"]): string[] {
  if (!(least <= largest)) return [];
  const [from, to] = [least, largest].map((value) => String(Number((value / 1000).toPrecision(kDigits)))) as [string, string];
  const unit = strings.units.stiffness;
  return [from === to ? words.stiffness(from, unit) : words.changed(words.stiffness(words.fromTo(from, to), unit))];
}

export function factsOf(shown: Shown, span: Span): string[] {
  const { circumstances, stiffness } = inForce(shown, span);
  const known = circumstances.filter((one): one is Circumstances => one !== undefined);
  const begin = new Date(1000 * (span.from + shown.utcOffset));
  const fact = (valueOf: (one: Circumstances) => string, say: (values: string) => string): string[] => {
    const values = [...new Set(known.map(valueOf))].filter((value) => value !== "");
    if (values.length === 0) return [];
    return [values.length === 1 ? say(values[0]!) : words.changed(say(values.join(words.join)))];
  };
  const device = ({ device: name, simulated }: Circumstances) => (name === "" ? "" : simulated === false ? words.device(name) : words.simulated(name));
  return [
    savedMark(shown),
    ...fact(({ scene }) => scene, words.scene),
    ...stiffnessFact(stiffness),
    ...fact(({ law }) => strings.force.laws[law] ?? law, words.law),
    ...fact(({ stabiliser }) => strings.calm.methods[stabiliser] ?? stabiliser, words.stabiliser),
    ...fact(({ rate }) => rate, (rate) => words.rate(rate, strings.units.hertz)),
    ...fact(device, (devices) => devices),
    ...(known.length > 0 && known.length < circumstances.length ? [words.partly] : []),
    ...(Number.isNaN(begin.getTime()) ? [] : [words.begin(begin.toLocaleString(strings.figures, kMoment))]),
  ].filter((one) => one !== "");
}
