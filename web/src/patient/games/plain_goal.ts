// SPDX-License-Identifier: Apache-2.0
// The goal in plain shapes, for a browser that draws no 3D: a bar with its band, circles for digits, a ring that opens and closes.
import type { ExerciseNow, GameOptions } from "../game";
import { svg } from "../demonstration";
import { forceTop } from "./force_scale";
import { bounded, finite } from "./marks";

export class PlainGoal {
  readonly element = svg("svg", { viewBox: "0 0 200 200", class: "plain-goal" }) as SVGSVGElement;
  private top = 1;
  private drawn = "";

  constructor() {
    this.element.style.cssText = "position:absolute;inset:0;margin:auto;width:min(60vw,60vh);height:min(60vw,60vh)";
    this.element.setAttribute("aria-hidden", "true");
  }

  show(exercise: ExerciseNow, options: GameOptions): void {
    const parts = this.parts(exercise);
    const drawn = `${options.contrast} ${parts}`;
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    const line = options.contrast ? "#ffffff" : "#17344a";
    const fill = options.contrast ? "#f6b73c" : "#fff6e4";
    this.element.innerHTML = `<g fill="${fill}" stroke="${line}" stroke-width="3" stroke-linecap="round">${parts}</g>`;
  }

  private parts(exercise: ExerciseNow): string {
    const { target } = exercise;
    const value = finite(exercise.value);
    if (exercise.hidesScene || target.kind === "explore" || target.kind === "choose") {
      const chosen = target.sponge;
      return [0, 1].map((at) => `<path d="M${20 + 90 * at} 130q35 -90 70 0z" stroke-width="${chosen === at ? 9 : 3}"/>${Array.from({ length: at + 1 }, (_, dot) => `<circle cx="${55 + 90 * at - 8 * at + 16 * dot}" cy="155" r="5"/>`).join("")}`).join("");
    }
    if (target.kind === "force") {
      this.top = forceTop(this.top, exercise);
      const y = (force: number) => 185 - 170 * bounded(force / this.top);
      return `<path d="M60 ${y(target.high)}h80M60 ${y(target.low)}h80" stroke-dasharray="6 7"/><rect x="85" y="${y(value)}" width="30" height="${Math.max(1, 185 - y(value))}" rx="8"/>`;
    }
    if (target.kind === "squeeze" || (target.kind === "open" && exercise.measure === "squeeze_release")) return `<circle cx="100" cy="100" r="${(20 + 70 * (1 - Math.exp(-value / 6))).toFixed(1)}"/>`;
    const wanted = (digit: number) => target.digits.includes(digit);
    return [0, 1, 2, 3, 4].map((digit) => {
      const x = exercise.side === "left" ? 20 + 40 * digit : 180 - 40 * digit;
      const goal = finite(target.flexion[digit], -1);
      return `<circle cx="${x}" cy="${(60 + 80 * bounded(finite(exercise.flexion[digit]))).toFixed(1)}" r="14" stroke-width="${wanted(digit) ? 7 : 2}"/>${goal >= 0 ? `<path d="M${x - 18} ${60 + 80 * goal}h36" stroke-dasharray="5 6"/>` : ""}`;
    }).join("");
  }
}
