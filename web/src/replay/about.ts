// SPDX-License-Identifier: Apache-2.0
// Facts about a recording.
import { el, section, setShown, setText } from "../panels/dom";
import { strings } from "../strings";
import type { Overview } from "./overview";
import type { Player } from "./player";
import { durationText, momentText, sizeText } from "../panels/as_text";

const words = strings.replay;

export interface About {
  readonly element: HTMLElement;
  update(): void;
}

export function about(player: Player, overview: Overview): About {
  const { recording } = player;
  const list = el("dl", { class: "facts" });
  const damaged = el("p", { class: "warning", role: "status", hidden: true });
  return {
    element: section(words.about, damaged, list),
    update() {
      const station = player.station;
      const rate = overview.rateAt(player.playhead.position);
      const missing = overview.holes.reduce((sum, { gap }) => sum + gap.steps, 0);
      const facts = [
        [words.facts.file, recording.source.name],
        [words.facts.begin, momentText(Number(recording.layout.begin) / 1e9)],
        [words.facts.length, durationText(recording.seconds)],
        [words.facts.scene, station?.scene ?? ""],
        [words.facts.device, station?.device ?? ""],
        [words.facts.rate, rate > 0 ? words.rate(String(rate)) : ""],
        [words.facts.gaps, missing.toLocaleString(strings.figures)],
        [words.facts.size, sizeText(recording.bytes)],
        [words.facts.version, recording.version],
      ];
      const wanted = facts.join("\n");
      if (list.dataset["shown"] !== wanted) {
        list.dataset["shown"] = wanted;
        list.replaceChildren(...facts.flatMap(([label, value]) => [el("dt", {}, label), el("dd", {}, value || strings.dash)]));
      }
      const parts = Math.max(player.damagedChunks, overview.damaged);
      setText(damaged, words.damaged(parts));
      setShown(damaged, parts > 0);
    },
  };
}
