// SPDX-License-Identifier: Apache-2.0
// Reads the goal aloud with the browser's own voice.

const kRate = 0.85; // of the usual speed
const kRepeatMs = 4000; // the same words again are read at most so often

export class Speech {
  private said = "";
  private at = -Infinity;

  /// @param language  code of the texts
  constructor(private readonly language: string, private readonly on: () => boolean) {}

  /// Reads a text once; a newer one interrupts it.
  say(text: string, now: number = Date.now()): void {
    if (text === this.said && now - this.at < kRepeatMs) return;
    const same = text === this.said;
    this.said = text;
    this.at = now;
    if (same || text === "" || !this.on() || !("speechSynthesis" in window)) return;
    const { speechSynthesis } = window;
    speechSynthesis.cancel();
    const spoken = new SpeechSynthesisUtterance(text);
    spoken.lang = this.language;
    spoken.rate = kRate;
    const voice = speechSynthesis.getVoices().find(({ lang }) => lang.startsWith(this.language));
    if (voice) spoken.voice = voice;
    speechSynthesis.speak(spoken);
  }

  hush(): void {
    this.said = "";
    window.speechSynthesis?.cancel();
  }
}
