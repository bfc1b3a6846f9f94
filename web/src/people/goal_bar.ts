// SPDX-License-Identifier: Apache-2.0
// What the participant should do now and how near it is: a bar with the band of the goal and the present value, and the force of each digit.
import { el, setAttribute, setShown, setText } from "../panels/dom";
import { strings } from "../strings";
import type { ExerciseNow } from "./exercise_now";
import { valueText, words } from "./words";

const kLeastForce = 5; // right end of the bar [N]
const kLeastAngle = 90; // [deg]
const kBandRoom = 1.6; // the bar ends so many times the band's upper end
const kFigures = 1;

const percent = (share: number) => `${(100 * Math.min(1, Math.max(0, share))).toFixed(1)}%`;
const rounded = (value: number) => Number(value.toFixed(kFigures));

export class GoalBar {
  private readonly goal = el("span", { class: "goal-what" });
  private readonly value = el("output", { class: "goal-value" });
  private readonly band = el("span", { class: "goal-band" });
  private readonly fill = el("span", { class: "goal-fill" });
  private readonly bar = el("div", { class: "goal-bar", "aria-hidden": "true" }, this.fill, this.band);
  private readonly limits = el("small", {});
  readonly element = el("div", { class: "goal" }, el("div", { class: "goal-line" }, this.goal, this.value), this.bar, this.limits);
  private largest = 0; // value that this exercise has shown: the bar's scale never shrinks
  private number = 0;

  show(now: ExerciseNow): void {
    if (now.number !== this.number) {
      this.number = now.number;
      this.largest = 0;
    }
    const digits = now.digits.map((digit) => words.run.digits[digit] ?? digit).join(", ");
    const goal = words.run.goal[now.target] ?? now.target;
    setText(this.goal, digits === "" || now.target === "none" ? goal : `${goal}: ${digits}`);
    const { value, low, high, unit } = now;
    const inBand = value !== undefined && low !== undefined && high !== undefined && value >= low && value <= high;
    setText(this.value, value === undefined ? "" : `${valueText(rounded(value), unit)}${inBand ? ` ${words.dash} ${words.run.inBand}` : ""}`);
    this.largest = Math.max(this.largest, value ?? 0, kBandRoom * (high ?? 0));
    const end = Math.max(this.largest, unit === "deg" ? kLeastAngle : kLeastForce);
    setShown(this.bar, value !== undefined);
    setAttribute(this.bar, "data-in", String(inBand));
    this.fill.style.width = percent((value ?? 0) / end);
    setShown(this.band, high !== undefined && low !== undefined);
    this.band.style.left = percent((low ?? 0) / end);
    this.band.style.width = percent(((high ?? 0) - (low ?? 0)) / end);
    setText(this.limits, low === undefined || high === undefined ? "" : words.run.band(valueText(rounded(low), ""), valueText(rounded(high), unit)));
    setShown(this.limits, this.limits.textContent !== "");
  }
}

const kForceEnd = 10; // of a digit's bar [N]

export class ForceBars {
  private readonly rows = strings.digits.map((name, digit) => {
    const fill = el("span", { class: "goal-fill", "data-digit": String(digit) });
    const value = el("span", { class: "figure" });
    return { fill, value, row: el("li", {}, el("span", {}, name), el("span", { class: "force-bar", "aria-hidden": "true" }, fill), value) };
  });
  private readonly hidden = el("p", { class: "hint" }, words.run.hidden);
  private readonly list = el("ul", {}, ...this.rows.map(({ row }) => row));
  readonly element = el("div", { class: "forces" }, el("h3", {}, words.run.forces), this.list, this.hidden);

  show({ forces }: ExerciseNow): void {
    setShown(this.hidden, forces.length === 0);
    setShown(this.list, forces.length > 0);
    this.rows.forEach(({ fill, value }, digit) => {
      const force = forces[digit] ?? 0;
      fill.style.width = percent(force / kForceEnd);
      setText(value, valueText(rounded(force), strings.units.newton));
    });
  }
}
