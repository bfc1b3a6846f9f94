// SPDX-License-Identifier: Apache-2.0
// Soft notes made by the browser. A browser plays nothing before the first touch of the page.
import type { GameSound } from "./game";

const kScale = [261.63, 293.66, 329.63, 392, 440]; // C D E G A: any two of them sound well together [Hz]
const kDecay = 1.4; // [s]
const kLoudest = 0.22;
const kLeastGap = 0.05; // between two notes of a pitch [s]

export class Sound implements GameSound {
  private context: AudioContext | undefined;
  private readonly last = new Map<number, number>();

  /// @param on  false while sound is off or must not be heard
  constructor(private readonly on: () => boolean) {}

  /// Called at a touch or key, which browsers demand.
  wake(): void {
    try {
      this.context ??= new AudioContext();
      if (this.context.state === "suspended") void this.context.resume().catch(() => undefined);
    } catch {
      // a browser without sound: the pictures show it all
    }
  }

  note(pitch: number, loudness = 0.6): void {
    this.play(pitch, loudness, 0);
  }

  glad(): void {
    [0, 2, 4].forEach((pitch, i) => this.play(pitch + 1, 0.5, 0.16 * i));
  }

  private play(pitch: number, loudness: number, delay: number): void {
    const { context } = this;
    if (!context || context.state !== "running" || !this.on()) return;
    const begin = context.currentTime + delay;
    if (begin - (this.last.get(pitch) ?? -1) < kLeastGap) return;
    this.last.set(pitch, begin);
    const step = ((pitch % kScale.length) + kScale.length) % kScale.length;
    const frequency = kScale[step]! * 2 ** Math.floor(pitch / kScale.length);
    for (const [partial, share] of [[1, 1], [2.76, 0.14], [5.4, 0.05]] as const) {
      const tone = context.createOscillator();
      const gain = context.createGain();
      tone.frequency.value = frequency * partial;
      gain.gain.setValueAtTime(0, begin);
      gain.gain.linearRampToValueAtTime(kLoudest * share * Math.min(1, Math.max(0, loudness)), begin + 0.008);
      gain.gain.exponentialRampToValueAtTime(1e-4, begin + kDecay / partial ** 0.6);
      tone.connect(gain).connect(context.destination);
      tone.start(begin);
      tone.stop(begin + kDecay);
    }
  }
}
