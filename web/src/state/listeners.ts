// SPDX-License-Identifier: Apache-2.0

/// Listeners to the parts of a state, by topic.
export class Listeners<Topic extends string> {
  private readonly lists = new Map<Topic, (() => void)[]>();

  on(topics: readonly Topic[], listener: () => void): void {
    for (const topic of topics) {
      const list = this.lists.get(topic) ?? [];
      list.push(listener);
      this.lists.set(topic, list);
    }
  }

  /// A listener that throws is reported; the others are still called.
  tell(topic: Topic): void {
    for (const listener of this.lists.get(topic) ?? []) {
      try {
        listener();
      } catch (reason) {
        console.error(reason);
      }
    }
  }
}
