// SPDX-License-Identifier: Apache-2.0
// Above the view: the stability verdict as a light, the force of each digit on the scale of forces, and which digits cannot have one.
import { digitForces, kDigits, notFelt } from "../state/channels";
import type { Shown } from "../state/shown";
import type { Verdict } from "../state/verdict";
import { strings } from "../strings";
import { forceScale, isAtLimit, shareOf } from "../view3d/force_scale";
import { el, setAttribute, setShown, setText } from "./dom";

/// "SHAKES, 11 Hz, 1.2 N".
export function verdictText(verdict: Verdict | null): string {
  const words = strings.verdict;
  if (verdict === null) return words.unknown;
  if (verdict.kind !== "shakes") return words[verdict.kind];
  if (!Number.isFinite(verdict.frequency) || !Number.isFinite(verdict.swing)) return words.shakes;
  return words.shakesFull(verdict.frequency.toFixed(0), verdict.swing.toFixed(1));
}

/// On a device that renders no torque, such as a glove that only stops a digit, the force cannot be felt.
function asFelt(verdict: Verdict, rendersTorque: boolean): Verdict {
  return verdict.kind === "steady" && !rendersTorque ? { kind: "off" } : verdict;
}

/// A part of the page that is updated at a rate at which figures can be read.
export interface Readouts {
  readonly element: HTMLElement;
  update(): void;
}

/// @param below  which digits cannot have a force
export function readouts(shown: Shown, below: Readouts): Readouts {
  const text = el("strong");
  const spoken = el("span", { class: "visually-hidden", role: "status" });
  const alarm = el("span", { class: "visually-hidden", role: "alert" });
  const light = el("div", { class: "verdict" }, el("span", { class: "lamp", "aria-hidden": "true" }), el("div", {}, el("small", {}, strings.verdict.label), text), spoken, alarm);
  const digits = Array.from({ length: kDigits }, (_, digit) => {
    const value = el("output", { "aria-label": strings.digits[digit] ?? "", "aria-live": "off" }); // it changes all the time
    const bar = el("span", { class: "bar" });
    const unfelt = el("small", { class: "digit-note", hidden: true }, strings.notFelt);
    const atLimit = el("strong", { class: "digit-note", hidden: true }, strings.atLimit);
    const box = el(
      "div",
      { class: "digit-force", "data-digit": digit },
      el("span", { class: "digit-name" }, strings.digits[digit] ?? ""),
      el("span", { class: "digit-value" }, value, el("span", { class: "unit" }, strings.units.newton)),
      el("span", { class: "bar-track", "aria-hidden": "true" }, bar),
      unfelt,
      atLimit,
    );
    return { box, value, bar, unfelt, atLimit };
  });
  const element = el(
    "div",
    { class: "readouts" },
    light,
    el("div", { class: "digit-forces", role: "group", "aria-label": strings.forcePerDigit }, ...digits.map((digit) => digit.box)),
    below.element,
  );
  shown.on(["state"], () => {
    const all = notFelt(shown);
    digits.forEach(({ box, unfelt }, i) => {
      setShown(unfelt, all[i] ?? false);
      unfelt.title = shown.rendersTorque ? strings.followsWhy : strings.noTorqueWhy;
      setAttribute(box, "data-felt", String(!(all[i] ?? false)));
    });
  });
  const update = () => {
    const verdict = shown.lost || !shown.tick ? null : asFelt(shown.light.shown, shown.rendersTorque);
    setAttribute(light, "data-verdict", verdict?.kind ?? "unknown");
    setText(text, verdictText(verdict));
    // The figures change all the time; only the verdict itself is spoken, and only shaking into the middle of something.
    const shakes = verdict?.kind === "shakes";
    setText(spoken, shakes ? "" : verdictText(verdict));
    setText(alarm, shakes ? strings.verdict.shakes : "");
    below.update();
    const forces = digitForces(shown.lost ? undefined : shown.tick);
    const scale = forceScale(shown.digitLimit);
    digits.forEach((digit, i) => {
      const force = forces[i] ?? 0;
      setShown(digit.atLimit, digit.unfelt.hidden && isAtLimit(scale, force));
      setText(digit.value, shown.lost || !shown.tick ? strings.dash : force.toFixed(1));
      digit.bar.style.transform = `scaleX(${shareOf(scale, force).toFixed(3)})`;
    });
  };
  update();
  return { element, update };
}
