// SPDX-License-Identifier: Apache-2.0
// The patient's screen of a station, as the patient sees it.
import type { Locator, Page } from "playwright-core";
import { kHangMs } from "./until";

export class PatientScreen {
  readonly errors: string[] = [];

  constructor(readonly page: Page) {
    page.on("pageerror", (error) => this.errors.push(String(error.stack ?? error)));
    page.setDefaultTimeout(kHangMs);
  }

  brief(): string {
    return `the patient's screen at ${this.page.url()}`;
  }

  /// What it asks of the patient now.
  get goal(): Locator {
    return this.page.locator(".goal h1");
  }

  /// Waits for a kind of picture: "play" is a game.
  async until(screen: string): Promise<void> {
    await this.page.locator(`.patient[data-screen="${screen}"]`).waitFor();
  }
}
