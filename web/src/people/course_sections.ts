// SPDX-License-Identifier: Apache-2.0
// What was measured and entered of one patient: results, clinical tests, trends, notes.
import { el, section } from "../panels/dom";
import { form, table, type FieldPlan } from "./form";
import type { Course, EnteredTest, Exercise, Result, ScoreValue, TestKind, Trend } from "./shapes";
import { trendFigure } from "./trend_chart";
import { changeText, figureText, scoreName, timeText, titleOf, trendTitle, valueText, verdictText, words } from "./words";

const hint = (text: string) => el("p", { class: "hint" }, text);

export function scoreItem(score: ScoreValue): HTMLElement {
  const { unit, origin, value, invalid } = score;
  const said = invalid === "" ? valueText(value, unit) : invalid;
  const from = invalid === "" ? (words.origins[origin] ?? origin) : words.results.notValid;
  return el("li", {}, `${scoreName(score)}: ${said} `, el("small", {}, from));
}

function resultRow(one: Result, exercises: readonly Exercise[]): readonly (Node | string)[] {
  const marks = [one.invalid === "" ? "" : `${words.results.notValid}: ${one.invalid}`, one.interrupted ? words.results.interrupted : ""].filter((mark) => mark !== "");
  const kind = one.assessment ? words.results.assessment : words.results.training;
  const scores = el("ul", { class: "people-scores" }, ...one.scores.map(scoreItem));
  return [
    timeText(one.date),
    el("span", {}, titleOf(exercises, one.exercise), " ", el("small", {}, kind)),
    el("div", {}, marks.length > 0 ? el("p", { class: "refused" }, marks.join("; ")) : null, scores),
  ];
}

const kResults = 10; // in sight at once

/// A part that is made when it is unfolded for the first time: a long course opens at once.
function folded(title: string, make: () => HTMLElement): HTMLElement {
  const box = el("details", {}, el("summary", {}, title));
  box.addEventListener("toggle", () => box.open && box.childElementCount === 1 && box.append(make()));
  return box;
}

export function resultsSection(course: Course, exercises: readonly Exercise[]): HTMLElement {
  const { title, none, columns } = words.results;
  const rows = (results: readonly Result[]) => table(title, Object.values(columns), results.map((one) => resultRow(one, exercises)));
  if (course.results.length === 0) return section(title, hint(none));
  const earlier = course.results.slice(kResults);
  return section(title, rows(course.results.slice(0, kResults)), earlier.length > 0 ? folded(words.trends.all(String(earlier.length)), () => rows(earlier)) : null);
}

const side = (name: string) => words.testSides[name] ?? name;
const kind = (name: string) => words.kinds[name] ?? name;

function testRow(one: EnteredTest): readonly (Node | string)[] {
  const noted = one.note === "" ? null : el("small", {}, one.note);
  return [one.date, kind(one.kind), side(one.side), el("span", {}, valueText(one.value, one.unit), " ", noted), one.rater];
}

/// @param enter  gets the form's values; what it throws is shown in it
export function testsSection(course: Course, kinds: readonly TestKind[], enter: (test: Readonly<Record<string, unknown>>) => Promise<void>): HTMLElement {
  const { title, none, columns } = words.tests;
  const choices = kinds.map(({ kind: value, least, most, unit }) => ({ value, text: `${kind(value)} (${words.tests.allowed(figureText(least), figureText(most), unit)})` }));
  const plans: readonly FieldPlan[] = [
    { name: "kind", label: words.tests.kind, kind: "choice", choices },
    { name: "side", label: words.tests.side, kind: "choice", choices: Object.entries(words.testSides).map(([value, text]) => ({ value, text })) },
    { name: "value", label: words.tests.value, kind: "number" },
    { name: "date", label: words.tests.date, kind: "date", hint: words.hints.date, longest: 10 },
    { name: "rater", label: words.tests.rater, kind: "text", hint: words.tests.raterHint, longest: 16 },
    { name: "note", label: words.tests.note, kind: "text" },
  ];
  return section(
    title,
    course.tests.length === 0 ? hint(none) : table(title, Object.values(columns), course.tests.map(testRow)),
    el("details", {}, el("summary", {}, words.tests.add), form(plans, {}, words.save, enter)),
  );
}

function trendRow(one: Trend, exercises: readonly Exercise[]): readonly (Node | string)[] {
  const figures = [valueText(one.first, one.unit), valueText(one.last, one.unit), changeText(one.last - one.first, one.unit), String(one.count)];
  return [trendTitle(one, exercises), ...figures.map((text) => el("span", { class: "figure" }, text)), verdictText(one)];
}

const kCharts = 6; // in sight at once

/// A chart for each trend of two or more values, what was entered by hand first; all of them as a table, too.
export function trendsSection(course: Course, exercises: readonly Exercise[]): HTMLElement {
  const { title, none, columns, more, asTable } = words.trends;
  if (course.trends.length === 0) return section(title, hint(none));
  const charts = course.trends.filter(({ count }) => count > 1).sort((a, b) => Number(b.entered) - Number(a.entered));
  const rest = charts.splice(kCharts);
  const grid = (figures: readonly HTMLElement[]) => el("div", { class: "trends" }, ...figures);
  return section(
    title,
    charts.length > 0 ? grid(charts.map((one) => trendFigure(one, exercises))) : hint(none),
    rest.length > 0 ? folded(more(String(rest.length)), () => grid(rest.map((one) => trendFigure(one, exercises)))) : null,
    folded(asTable, () => table(title, Object.values(columns), course.trends.map((one) => trendRow(one, exercises)))),
    hint(words.trends.hint),
  );
}

export function notesSection(course: Course, write: (text: string) => Promise<void>): HTMLElement {
  const { title, none, add, text } = words.notes;
  const items = course.notes.map((note) => el("li", {}, el("small", {}, `${timeText(note.date)}, ${note.account}`), el("p", {}, note.text)));
  return section(
    title,
    items.length === 0 ? hint(none) : el("ul", { class: "people-notes" }, ...items),
    el("details", {}, el("summary", {}, add), form([{ name: "text", label: text, kind: "area", longest: 4000 }], {}, words.save, (values) => write(String(values["text"])))),
  );
}
