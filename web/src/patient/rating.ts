// SPDX-License-Identifier: Apache-2.0
// The question how strong pain is, or how tired the patient is: six faces, or all eleven numbers with a face above each.
import { el, setShown, setText } from "../panels/dom";
import { face } from "./faces";
import type { GameOptions, Rating } from "./game";
import { linePicture } from "./pictures";
import { words } from "./words";

const kMost = 10;
const kFaces = [0, 2, 4, 6, 8, 10];
export const kDeafMs = 800; // after a new question or an answer: a tremor or a second tap would answer what was not read

export interface RatingPanel {
  readonly element: HTMLElement;
  /// @param kind  undefined: nothing is asked, the panel is hidden  @param title  is displayed here unless the frame shows the question already
  show(kind: Rating | undefined, options: GameOptions, title: boolean): void;
  /// Gives the question the focus: the faces come next by Tab, and a key that is held down answers nothing.
  focus(): void;
}

/// @param choose  is called with the kind and 0 .. 10  @param back  closes a panel that the patient has opened
export function ratingPanel(choose: (kind: Rating, value: number) => void, back: () => void): RatingPanel {
  const question = el("span");
  const sign = el("span", { class: "rating-sign" });
  const heading = el("h2", { class: "rating-title", tabindex: -1 }, sign, question);
  const list = el("div", { class: "faces", role: "group" });
  const leave = el("button", { type: "button", class: "soft rating-back" }, words.rating.back);
  leave.addEventListener("click", back);
  const element = el("section", { class: "rating", hidden: true }, heading, list, leave);
  let asked: Rating | undefined;
  let made = "";
  let hears: ReturnType<typeof setTimeout> | undefined;
  const beDeaf = () => {
    clearTimeout(hears);
    list.dataset["hears"] = "false";
    hears = setTimeout(() => (list.dataset["hears"] = "true"), kDeafMs);
  };
  const pressed = (kind: Rating, value: number) => {
    if (list.dataset["hears"] !== "true") return;
    beDeaf();
    choose(kind, value);
  };
  const show = (kind: Rating | undefined, options: GameOptions, title: boolean) => {
    setShown(element, kind !== undefined);
    if (kind !== asked && kind !== undefined) beDeaf();
    asked = kind;
    if (kind === undefined) return;
    const numbers = options.numbers && !options.aphasia;
    const wanted = `${kind} ${numbers} ${options.aphasia} ${title}`;
    if (wanted === made) return;
    made = wanted;
    setText(question, words.rating[kind]);
    sign.replaceChildren(linePicture(kind)); // that of its button in the bar
    heading.hidden = leave.hidden = !title;
    list.setAttribute("aria-label", words.rating[kind]);
    element.setAttribute("aria-label", words.rating[kind]);
    element.dataset["numbers"] = String(numbers);
    const values = numbers ? Array.from({ length: kMost + 1 }, (_, value) => value) : kFaces;
    list.replaceChildren(
      ...values.map((value) => {
        const word = words.rating[kind === "pain" ? "painWords" : "tiredWords"][Math.round(value / 2)]!;
        const label = options.aphasia ? null : el("span", { class: "face-word" }, numbers ? String(value) : word);
        const button = el("button", { type: "button", class: "face-button", "data-value": value, "aria-label": numbers ? words.rating.number(String(value), word) : word }, label);
        button.prepend(face(kind, value));
        button.addEventListener("click", () => pressed(kind, value));
        return button;
      }),
    );
  };
  return { element, show, focus: () => heading.focus() };
}
