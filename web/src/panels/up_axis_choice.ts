// SPDX-License-Identifier: Apache-2.0
// The choice of the axis of a mesh file that points up.
import { upAxes, type UpAxis } from "../state/up_axis";
import { strings } from "../strings";
import { button, el, newId, setAttribute } from "./dom";

const words = strings.object;

export class UpAxisChoice {
  private axis: UpAxis = "z";
  private readonly buttons = upAxes.map((axis) => ({ axis, made: button(words.axes[axis], () => this.pick(axis)) }));
  readonly element: HTMLElement;

  /// @param picked  called when the user has chosen another axis
  constructor(private readonly picked: () => void) {
    const id = newId("up-axis");
    this.element = el(
      "div",
      { class: "up-axis" },
      el("span", { id }, words.up),
      el("div", { class: "segmented", role: "group", "aria-labelledby": id }, ...this.buttons.map(({ made }) => made)),
      el("p", { class: "hint" }, words.upHint),
    );
    this.value = this.axis;
  }

  get value(): UpAxis {
    return this.axis;
  }

  set value(axis: UpAxis) {
    this.axis = axis;
    for (const one of this.buttons) setAttribute(one.made, "aria-pressed", String(one.axis === axis));
  }

  private pick(axis: UpAxis): void {
    if (axis === this.axis) return;
    this.value = axis;
    this.picked();
  }
}
