// SPDX-License-Identifier: Apache-2.0
// Over the view: why the hand cannot be seen, or is not that of the displayed moment.
import { button, el, setShown, setText } from "../panels/dom";
import { isMeasured } from "../state/channels";
import { strings } from "../strings";
import type { Overview } from "./overview";
import { kLongRead, type Player } from "./player";
import { troubleText } from "./trouble";

const words = strings.replay;

export interface Note {
  readonly element: HTMLElement;
  update(now: number): void; // [ms]
}

/// @param again  tries again what could not be read
export function note(player: Player, overview: Pick<Overview, "trouble">, again: () => void): Note {
  const text = el("p", { role: "status" });
  const alarm = el("p", { role: "alert" });
  const retry = button(words.retry, again);
  const element = el("div", { class: "replay-note", hidden: true }, text, alarm, retry);
  const trouble = () => player.trouble ?? overview.trouble;
  let readingSince: number | undefined;
  function what(now: number): string {
    readingSince = player.loading ? (readingSince ?? now) : undefined;
    if (trouble() !== undefined) return "";
    if (readingSince !== undefined && now - readingSince > kLongRead) return words.reading;
    if (player.hole) return words.hole;
    if (player.tick && !isMeasured(player.tick)) return words.unmeasured;
    if (player.recording.count("/geometry") === 0) return words.noGeometry;
    if (player.shapesTrouble) return words.badShapes;
    return player.geometry ? "" : words.noGeometryYet;
  }
  return {
    element,
    update(now) {
      setText(text, what(now));
      const why = trouble();
      setText(alarm, why === undefined ? "" : `${words.cut} ${troubleText(why, player.recording.source.name)}`);
      setShown(retry, why !== undefined);
      setShown(element, text.textContent !== "" || alarm.textContent !== "");
    },
  };
}
