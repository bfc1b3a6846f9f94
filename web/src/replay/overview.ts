// SPDX-License-Identifier: Apache-2.0
// The whole recording at a glance: the force on each digit over time, events and missing steps. Filled in the background.
import { kDigits } from "../state/channels";
import { kSurveyRow, lastAt, type ChunkSurvey, type EventFacts, type GapFacts, type Timed } from "./chunk";
import { readRun, runsOf } from "./chunk_reader";
import { DecoderError, type Decoder } from "./decoder";
import type { Recording } from "./recording";
import type { StationFacts } from "./station_facts";

const kBins = 1200; // at most
const kBinsPerSecond = 30; // two poses in each
const kCoarse = 240; // chunks of the first pass over the whole length
const kTopics = ["/event", "/gap", "/setup", "/geometry"];

/// The order in which chunks are surveyed: those with events, then every n-th, then the others.
export function surveyOrder(recording: Pick<Recording, "chunks">): number[][] {
  const all = recording.chunks.map((_, i) => i);
  const marked = all.filter((i) => kTopics.some((topic) => recording.chunks[i]!.topics.has(topic)));
  const every = Math.ceil(all.length / kCoarse);
  const seen = new Set(marked);
  const coarse = all.filter((i) => i % every === 0 && !seen.has(i));
  coarse.forEach((i) => seen.add(i));
  return [marked, coarse, all.filter((i) => !seen.has(i))];
}

/// Steps that are missing, with the time that they cover.
export interface Hole {
  readonly begin: number; // [s]
  readonly end: number;
  readonly gap: GapFacts;
}

export class Overview {
  readonly bins: number;
  readonly peak: Float32Array; // largest force on each digit in each bin [N]; NaN: not known
  largest = 0; // of them [N]
  events: Timed<EventFacts>[] = []; // in the order of time
  stations: Timed<StationFacts>[] = [];
  private rates: Timed<number>[] = [];
  private readonly gaps: Timed<GapFacts>[] = [];
  private known: Hole[] | undefined; // `holes`, unless something was added since
  private readonly surveyed = new Set<number>(); // chunks
  damaged = 0;
  trouble: unknown; // why the survey has stopped before the end

  constructor(private readonly recording: Recording) {
    this.bins = Math.max(1, Math.min(kBins, Math.ceil(recording.seconds * kBinsPerSecond)));
    this.peak = new Float32Array(this.bins * kDigits).fill(NaN);
  }

  /// Share of the recording that has been surveyed, 0 .. 1.
  get progress(): number {
    return this.recording.chunks.length === 0 ? 1 : this.surveyed.size / this.recording.chunks.length;
  }

  binAt(time: number): number {
    const { seconds } = this.recording;
    return seconds > 0 ? Math.min(this.bins - 1, Math.max(0, Math.floor((time / seconds) * this.bins))) : 0;
  }

  /// Force on each digit around a time; undefined: not known yet, or no step.
  forcesAt(time: number): number[] | undefined {
    const bin = this.binAt(time);
    const forces = [...this.peak.subarray(kDigits * bin, kDigits * (bin + 1))];
    return forces.some(Number.isNaN) ? undefined : forces;
  }

  /// Steps a second; 0: not known.
  rateAt(time: number): number {
    return lastAt(this.rates, time)?.value ?? 0;
  }

  /// A gap is written before the first step behind it.
  get holes(): readonly Hole[] {
    this.known ??= this.gaps.map(({ time, value }) => {
      const rate = this.rateAt(time);
      return { begin: Math.max(0, time - (rate > 0 ? value.steps / rate : 0)), end: time, gap: value };
    });
    return this.known;
  }

  private add(chunk: number, survey: ChunkSurvey): void {
    const { forces } = survey;
    for (let row = 0; row + kSurveyRow <= forces.length; row += kSurveyRow) {
      const bin = kDigits * this.binAt(forces[row]!);
      for (let digit = 0; digit < kDigits; ++digit) {
        const force = forces[row + 1 + digit]!;
        const before = this.peak[bin + digit]!;
        this.peak[bin + digit] = before > force ? before : force; // NaN is no larger
        this.largest = Math.max(this.largest, force);
      }
    }
    const byTime = (a: Timed<unknown>, b: Timed<unknown>) => a.time - b.time;
    if (survey.events.length > 0) this.events = [...this.events, ...survey.events].sort(byTime);
    if (survey.stations.length > 0) this.stations = [...this.stations, ...survey.stations].sort(byTime);
    if (survey.rates.length > 0) this.rates = [...this.rates, ...survey.rates].sort(byTime);
    this.gaps.push(...survey.gaps);
    if (survey.rates.length > 0 || survey.gaps.length > 0) this.known = undefined;
    this.surveyed.add(chunk);
  }

  /// Surveys what is not surveyed yet, in the best case the whole recording; `trouble` says why it ends earlier. Between two reads it
  /// lets others work.
  async fill(decoder: Decoder, changed: () => void, signal: AbortSignal): Promise<void> {
    this.trouble = undefined;
    try {
      await this.fillRest(decoder, changed, signal);
    } catch (reason) {
      this.trouble = reason;
    }
  }

  private async fillRest(decoder: Decoder, changed: () => void, signal: AbortSignal): Promise<void> {
    const { chunks, source } = this.recording;
    for (const pass of surveyOrder(this.recording)) {
      for (const run of runsOf(chunks, pass.filter((chunk) => !this.surveyed.has(chunk)))) {
        if (signal.aborted) return;
        for (const [i, bytes] of (await readRun(source, chunks, run)).entries()) {
          const survey = await decoder.survey(bytes).catch((reason: unknown) => {
            if (reason instanceof DecoderError) throw reason;
            return undefined;
          });
          if (signal.aborted) return;
          if (!survey) ++this.damaged;
          this.add(run[i]!, survey ?? { forces: new Float64Array(), events: [], gaps: [], stations: [], rates: [] });
        }
        changed();
        await new Promise((resolve) => setTimeout(resolve));
      }
      changed();
    }
  }
}
