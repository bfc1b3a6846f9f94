// SPDX-License-Identifier: Apache-2.0
// Prescriptions that are ready for use: one button each, which states what it prescribes.
import { button, el, setShown, setText } from "../panels/dom";
import { doseText } from "./begin_exercise";
import type { Exercise, Template } from "./shapes";
import { refusalText } from "./trouble";
import { titleOf, titleText, words } from "./words";

/// The lines of a template as the station's JSON has them.
export const templateLines = ({ lines }: Template): readonly Readonly<Record<string, unknown>>[] =>
  lines.map(({ exercise, repetitions, minutes, note, overrides }) => ({ exercise, repetitions_per_day: repetitions, minutes_per_day: minutes, note, overrides }));

/// In a word or two; a template of the clinic’s own has the words before the colon of its title.
export const templateName = (one: Template): string => words.templates.names[one.name] ?? titleText(one).split(":")[0] ?? one.name;

/// @param replaces  there is a prescription, which a template would replace  @param use  what it throws is shown
export function templateList(templates: readonly Template[], exercises: readonly Exercise[], replaces: boolean, use: (template: Template) => Promise<void>): HTMLElement {
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  const titles = ({ lines }: Template) =>
    lines.map((line) => el("li", {}, titleOf(exercises, line.exercise), " ", el("small", {}, doseText(line))));
  const items = templates.map((one) => {
    const press = button(words.templates.use(templateName(one)), () => {
      press.disabled = true;
      setShown(refused, false);
      void use(one)
        .catch((reason: unknown) => {
          setText(refused, refusalText(reason));
          setShown(refused, true);
        })
        .finally(() => (press.disabled = false));
    });
    return el("li", { class: "template" }, press, el("small", {}, titleText(one)), el("ul", {}, ...titles(one)));
  });
  return el(
    "div",
    { class: "templates" },
    replaces && items.length > 0 ? el("p", { class: "hint" }, words.templates.replaces) : null,
    items.length === 0 ? el("p", { class: "hint" }, words.templates.empty) : el("ul", { class: "template-list" }, ...items),
    refused,
  );
}
