// SPDX-License-Identifier: Apache-2.0
// The words of the screen: one goal, large; below it how far the phase and the exercise have come.
import { picture as symbolPicture } from "../people/symbols";
import { el, setShown, setText } from "../panels/dom";
import type { ExerciseNow, GameOptions } from "./game";
import { choiceText, type Goal } from "./goal";
import { choicePicture } from "./choice_pictures";
import { linePicture } from "./pictures";
import { words } from "./words";

const kMostBeads = 24;

export interface GoalPanel {
  readonly element: HTMLElement;
  update(goal: Goal, now: ExerciseNow | undefined, options: GameOptions): void;
}

function pictureOf(goal: Goal, now: ExerciseNow | undefined): Node[] {
  switch (goal.picture) {
    case "symbol":
      return now && now.symbol !== "" ? [symbolPicture(now.symbol), el("span", { class: "symbol-word" }, words.symbols[now.symbol] ?? now.symbol)] : [linePicture("hand")];
    case "hand":
      return [linePicture("hand")];
    case "second":
      return [linePicture("hand"), choicePicture("", 1)];
    case "cup":
      return [linePicture("pause")];
    case "stop":
    case "helper":
    case "pain":
    case "tired":
      return [linePicture(goal.picture)];
    case "line":
      return [el("span", { class: "dots" }, el("i"), el("i"), el("i"))];
    case "lights":
      return [linePicture("lantern")];
    default:
      return [];
  }
}

export function goalPanel(): GoalPanel {
  const title = el("h1");
  const more = el("p", { class: "goal-more" });
  const picture = el("div", { class: "goal-picture", hidden: true });
  const answers = el("ul", { class: "answers", hidden: true });
  const beads = el("div", { class: "beads", role: "img", hidden: true });
  const figures = el("p", { class: "figures", hidden: true });
  const time = el("i");
  const line = el("div", { class: "time-line", "aria-hidden": "true", hidden: true }, time);
  const said = el("div", { class: "goal-words", role: "status", "aria-live": "polite" }, title, more);
  const simulated = el("p", { class: "simulated", hidden: true }, words.simulated);
  const element = el("main", { class: "goal" }, picture, said, answers, el("div", { class: "goal-facts" }, beads, figures, simulated), line);
  let drawn = "";
  let listed = "";

  const showBeads = (now: ExerciseNow) => {
    const label = `${words.progress.label}: ${words.progress.of(String(now.trial), String(now.trials))}`;
    if (beads.getAttribute("aria-label") === label) return;
    beads.setAttribute("aria-label", label);
    const many = now.trials > kMostBeads;
    beads.dataset["many"] = String(many);
    if (many) {
      const fill = el("i");
      fill.style.width = `${(100 * (now.trial - 1)) / now.trials}%`;
      beads.replaceChildren(fill);
    } else beads.replaceChildren(...Array.from({ length: now.trials }, (_, i) => el("i", { "data-state": i + 1 < now.trial ? "done" : i + 1 === now.trial ? "now" : "next" })));
  };

  return {
    element,
    update(goal, now, options) {
      element.dataset["screen"] = goal.screen;
      setText(title, goal.text);
      setText(more, goal.more);
      setShown(more, goal.more !== "");
      const wanted = `${goal.picture} ${now?.symbol}`;
      if (wanted !== drawn) picture.replaceChildren(...pictureOf(goal, now));
      drawn = wanted;
      setShown(picture, picture.childElementCount > 0);
      const choices = goal.screen === "answer" ? (now?.choices ?? []) : [];
      if (choices.join("|") !== listed) {
        listed = choices.join("|");
        answers.replaceChildren(...choices.map((choice, i) => el("li", {}, choicePicture(choice, i), el("span", {}, choiceText(choice, words)))));
      }
      setShown(answers, choices.length > 0);
      const active = now !== undefined && (goal.screen === "play" || goal.screen === "rest" || goal.screen === "answer");
      const counts = active && now.trial > 0 && now.trials > 1 && now.phase !== "warm_up";
      if (counts) showBeads(now);
      setShown(beads, counts);
      const timed = active && now.remaining > 0;
      setShown(line, timed);
      if (timed) time.style.transform = `scaleX(${Math.min(1, Math.max(0, 1 - now.progress)).toFixed(3)})`;
      const told = !active || !options.numbers || options.aphasia ? [] : [
        counts ? words.progress.of(String(now.trial), String(now.trials)) : "",
        timed ? words.progress.left(String(Math.ceil(now.remaining))) : "",
        now.value === undefined ? "" : now.target.kind === "angle" ? words.progress.angle(now.value.toFixed(0)) : words.progress.force(now.value.toFixed(1)),
      ];
      setText(figures, told.filter((one) => one !== "").join(" · "));
      setShown(figures, figures.textContent !== "");
      setShown(simulated, now !== undefined && now.simulated && now.stage === "running");
    },
  };
}
