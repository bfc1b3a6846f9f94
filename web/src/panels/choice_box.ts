// SPDX-License-Identifier: Apache-2.0
// A choice of one among several. Not a native select: an open one takes Space and Esc for itself, and they mean Stop on this page.
// A button with the role combobox, and below it, in the flow of the page, the list; the focus stays on the button.
import { el, newId, setAttribute, setShown, setText } from "./dom";

export interface Choice {
  readonly value: string;
  readonly text: string;
  readonly title?: string;
}

export class ChoiceBox {
  readonly button: HTMLButtonElement;
  readonly list: HTMLElement;
  private choices: readonly Choice[] = [];
  private chosen = "";
  private active = -1; // in the open list

  /// @param picked  called when the user has chosen another value than the displayed one
  constructor(private readonly picked: () => void) {
    const id = newId("choices");
    this.list = el("div", { class: "choice-list", role: "listbox", id, hidden: true });
    this.button = el("button", {
      type: "button", class: "choice", role: "combobox", "aria-haspopup": "listbox", "aria-expanded": "false", "aria-controls": id,
    });
    this.button.addEventListener("click", () => (this.open ? this.close() : this.show()));
    this.button.addEventListener("keydown", (event) => this.key(event));
    this.button.addEventListener("blur", () => this.close());
    // The focus stays where it is, so that the list is still there when the press comes up.
    this.list.addEventListener("mousedown", (event) => event.preventDefault());
    this.list.addEventListener("click", (event) => {
      const option = event.target instanceof Element ? event.target.closest<HTMLElement>("[role=option]") : null;
      if (option) this.pick([...this.list.children].indexOf(option));
    });
  }

  get value(): string {
    return this.chosen;
  }

  set value(value: string) {
    this.chosen = value;
    this.label();
  }

  get open(): boolean {
    return !this.list.hidden;
  }

  /// How it is called, for those who cannot see it.
  name(label: string): void {
    setAttribute(this.button, "aria-label", label);
    setAttribute(this.list, "aria-label", label);
  }

  /// Leaves the list alone if it is the same.
  setChoices(choices: readonly Choice[]): void {
    const same = choices.length === this.choices.length && choices.every((one, i) => one.value === this.choices[i]?.value && one.text === this.choices[i]?.text);
    if (same) return;
    this.choices = choices;
    this.list.replaceChildren(
      ...choices.map((one) => el("div", { role: "option", id: newId("option"), "data-value": one.value, title: one.title }, one.text)),
    );
    this.active = -1;
    this.label();
  }

  private get usable(): boolean {
    return !this.button.disabled && this.button.closest("fieldset[disabled]") === null;
  }

  private label(): void {
    const at = this.choices.findIndex((one) => one.value === this.chosen);
    setText(this.button, this.choices[at]?.text ?? this.chosen);
    [...this.list.children].forEach((option, i) => setAttribute(option, "aria-selected", String(i === at)));
  }

  private show(): void {
    if (!this.usable) return;
    this.button.focus(); // not every browser gives it to a button that is clicked
    setShown(this.list, true);
    setAttribute(this.button, "aria-expanded", "true");
    this.mark(Math.max(0, this.choices.findIndex((one) => one.value === this.chosen)));
  }

  close(): void {
    setShown(this.list, false);
    setAttribute(this.button, "aria-expanded", "false");
    setAttribute(this.button, "aria-activedescendant", null);
  }

  private mark(at: number): void {
    this.active = Math.min(this.choices.length - 1, Math.max(0, at));
    [...this.list.children].forEach((option, i) => option.classList.toggle("active", i === this.active));
    const option = this.list.children[this.active];
    if (!option) return;
    setAttribute(this.button, "aria-activedescendant", option.id);
    option.scrollIntoView?.({ block: "nearest" });
  }

  private pick(at: number): void {
    const choice = this.choices[at];
    this.close();
    if (!choice || !this.usable || choice.value === this.chosen) return;
    this.value = choice.value;
    this.picked();
  }

  private key(event: KeyboardEvent): void {
    if (event.key === "Escape" || event.key === " ") return this.close(); // they stop, elsewhere
    if (event.ctrlKey || event.metaKey) return;
    if (!this.open) {
      if (event.key !== "Enter" && event.key !== "ArrowDown" && event.key !== "ArrowUp") return;
      this.show();
    } else if (event.key === "Enter") {
      this.pick(this.active);
    } else {
      const to: Readonly<Record<string, number>> = { ArrowDown: this.active + 1, ArrowUp: this.active - 1, Home: 0, End: this.choices.length - 1 };
      const at = to[event.key];
      if (at === undefined) return;
      this.mark(at);
    }
    event.preventDefault(); // neither a click of the button nor the page's scrolling
  }
}
