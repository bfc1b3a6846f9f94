// SPDX-License-Identifier: Apache-2.0
// What an exercise has measured, as soon as it has ended. The values are those of the registry, which makes them from the recording.
import { el, section } from "../panels/dom";
import { scoreItem } from "./course_sections";
import type { ExerciseNow } from "./exercise_now";
import { figureText, stationLanguage, words } from "./words";

const kMinute = 60; // [s]

export function endedView({ result, training }: ExerciseNow): HTMLElement {
  const { title, none } = { title: words.run.result, none: words.run.noResult };
  if (!result) return section(title, el("p", { class: "hint" }, none));
  const { scores, ended, interrupted, repetitions, successes, counted, seconds, verdict } = result;
  const minutes = `${figureText(Math.round((10 * seconds) / kMinute) / 10)} min`;
  return section(
    title,
    verdict === "" ? null : el("p", { class: "run-verdict", lang: stationLanguage }, verdict),
    el("p", { class: "run-facts" }, words.run.facts(String(repetitions), minutes)),
    training && counted > 0 ? el("p", { class: "run-facts" }, words.run.successes(String(successes), String(counted))) : null,
    interrupted ? el("p", { class: "refused" }, words.run.interrupted) : null,
    ended === "" ? null : el("p", { class: "hint", lang: stationLanguage }, ended),
    el("ul", { class: "people-scores" }, ...scores.map(scoreItem)),
  );
}
