// SPDX-License-Identifier: Apache-2.0
// What is always there: STOP, a break, pain and tired. Each acts at one tap.
import { el, setShown, setText } from "../panels/dom";
import { onPress } from "../panels/press";
import type { Rating } from "./game";
import { linePicture, type LinePicture } from "./pictures";
import { words } from "./words";

export interface BarActs {
  readonly stop: () => void;
  readonly pause: () => void;
  readonly pain: () => void;
  readonly tired: () => void;
}

export interface Bar {
  readonly element: HTMLElement;
  /// What was sent and what became of it; empty: nothing. @param bad  it must not be overlooked
  say(text: string, bad?: boolean): void;
  /// STOP lies on the side of the other hand.
  setSide(side: "left" | "right"): void;
  /// Gives the focus to the button of a rating.
  focus(kind: Rating): void;
}

export function bar(acts: BarActs): Bar {
  const made = (name: LinePicture, text: string, meaning: string, act: () => void) => {
    const button = el("button", { type: "button", class: `bar-button bar-${name}`, ...(meaning === "" ? {} : { title: meaning }) }, el("span", {}, text));
    button.prepend(linePicture(name));
    onPress(button, act);
    return button;
  };
  const said = el("p", { class: "bar-said", role: "status", hidden: true });
  const buttons = el(
    "div",
    { class: "bar-buttons" },
    made("stop", words.bar.stop, words.bar.stopMeaning, acts.stop),
    made("pause", words.bar.pause, words.bar.pauseMeaning, acts.pause),
    made("pain", words.bar.pain, "", acts.pain),
    made("tired", words.bar.tired, "", acts.tired),
  );
  const element = el("section", { class: "bar", "aria-label": words.bar.region }, said, buttons);
  return {
    element,
    say(text, bad = false) {
      setText(said, text);
      setShown(said, text !== "");
      said.dataset["bad"] = String(bad);
    },
    setSide(side) {
      element.dataset["side"] = side;
    },
    focus(kind) {
      buttons.querySelector<HTMLElement>(`.bar-${kind}`)?.focus();
    },
  };
}
