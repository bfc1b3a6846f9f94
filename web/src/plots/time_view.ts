// SPDX-License-Identifier: Apache-2.0
import type { History } from "../state/history";
import { Listeners } from "../state/listeners";

/// A stretch of time on the ticks' clock [s].
export interface Span {
  readonly from: number;
  readonly to: number;
}

export const ordered = (one: number, other: number): Span => ({ from: Math.min(one, other), to: Math.max(one, other) });
export const lengthOf = ({ from, to }: Span) => to - from;

/// The time that all plots show: the newest seconds or a zoomed part of them; the selection; the time that is pointed at.
export class TimeView extends Listeners<"span" | "selection" | "pointed"> {
  private window: number;
  private zoomed: Span | undefined;
  private held: Span | undefined;
  private selected: Span | undefined;
  private at: number | null = null;

  constructor(
    private readonly history: History,
    seconds: number,
  ) {
    super();
    this.window = seconds;
  }

  get seconds(): number {
    return this.window;
  }

  set seconds(seconds: number) {
    this.window = seconds;
    this.zoomed = undefined;
    this.tell("span");
  }

  get zoom(): Span | undefined {
    return this.zoomed;
  }

  /// A zoomed part stands still. @param span  undefined: the newest seconds again
  set zoom(span: Span | undefined) {
    this.zoomed = span;
    this.tell("span");
  }

  get selection(): Span | undefined {
    return this.selected;
  }

  set selection(span: Span | undefined) {
    this.selected = span;
    this.tell("selection");
  }

  /// null: none.
  get pointed(): number | null {
    return this.at;
  }

  set pointed(time: number | null) {
    if (time === this.at) return;
    this.at = time;
    this.tell("pointed");
  }

  /// The curves stand still while they are dragged over.
  hold(): void {
    this.held = this.span;
  }

  release(): void {
    this.held = undefined;
  }

  /// What the plots show.
  get span(): Span {
    const end = this.history.length > 0 ? this.history.end : 0;
    return this.held ?? this.zoomed ?? { from: end - this.window, to: end };
  }

  /// What was zoomed or selected ends when the history no longer has it.
  refresh(): void {
    const begin = this.history.time()[0] ?? NaN;
    const gone = (span: Span | undefined) => span !== undefined && !(span.to > begin && span.from < this.history.end);
    if (gone(this.zoomed)) this.zoom = undefined;
    if (gone(this.selected)) this.selection = undefined;
  }
}
