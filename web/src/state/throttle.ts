// SPDX-License-Identifier: Apache-2.0

/// Passes values on, at most `perSecond` a second. The last one is always passed on.
export class Throttle<T> {
  private waiting: { readonly value: T } | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private last = -Infinity;
  private readonly interval: number;

  constructor(
    private readonly send: (value: T) => void,
    perSecond: number,
    private readonly now: () => number = () => performance.now(),
  ) {
    this.interval = 1000 / perSecond;
  }

  /// @returns whether a value has been pushed and not yet passed on
  get waits(): boolean {
    return this.waiting !== null;
  }

  push(value: T): void {
    this.waiting = { value };
    if (this.timer !== undefined) return;
    const left = this.last + this.interval - this.now();
    if (left <= 0) {
      this.flush();
    } else {
      this.timer = setTimeout(() => this.flush(), left);
    }
  }

  /// Drops the waiting value.
  clear(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.waiting = null;
  }

  /// Passes the waiting value on at once.
  flush(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    if (!this.waiting) return;
    const { value } = this.waiting;
    this.waiting = null;
    this.last = this.now();
    this.send(value);
  }
}
