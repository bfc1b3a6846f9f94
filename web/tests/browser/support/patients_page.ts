// SPDX-License-Identifier: Apache-2.0
// The page of patients of a station: what a person finds on it, by the names that a screen reader says.
import type { Locator, Page } from "playwright-core";
import { en } from "../../../src/strings/people_en";
import { english } from "../../../src/strings";
import { kHangMs } from "./until";

export class PatientsPage {
  readonly errors: string[] = [];

  constructor(readonly page: Page) {
    page.on("pageerror", (error) => this.errors.push(String(error.stack ?? error)));
    page.setDefaultTimeout(kHangMs);
  }

  brief(): string {
    return `the page of patients at ${this.page.url()}`;
  }

  button(name: string): Locator {
    return this.page.getByRole("button", { name, exact: true });
  }

  /// A name may be followed by a hint.
  fieldLike(name: string): Locator {
    return this.page.getByRole("textbox", { name });
  }

  field(name: string): Locator {
    return this.page.getByRole("textbox", { name, exact: true });
  }

  get stopButton(): Locator {
    return this.page.getByRole("button", { name: english.texts.stop.button });
  }

  get stopBox(): Locator {
    return this.page.getByRole("region", { name: english.texts.stop.region });
  }

  /// The entry of the list, by its code.
  listed(code: string): Locator {
    return this.page.getByRole("navigation", { name: en.list.label }).getByRole("button", { name: code });
  }

  /// The displayed patient.
  patient(code: string): Locator {
    return this.page.getByRole("region", { name: en.patient.region(code), exact: true });
  }

  /// Opens a choice and takes one of it, by its value.
  async choose(name: string, value: string): Promise<void> {
    const box = this.page.getByRole("combobox", { name, exact: true });
    await box.click();
    await this.page.locator(`[id="${await box.getAttribute("aria-controls")}"] [data-value="${value}"]`).click();
  }

  async add(code: string, side: "left" | "right"): Promise<void> {
    await this.button(en.list.add).click();
    await this.fieldLike(en.fields["code"]!).fill(code);
    await this.page.getByRole("radiogroup", { name: en.fields["side"]!, exact: true }).getByRole("radio", { name: en.sides[side]! }).click();
    await this.button(en.save).click();
    await this.patient(code).waitFor();
  }

  /// Enters what was measured elsewhere for the displayed patient, and waits until the station has it.
  async enter(what: string, values: Readonly<Record<string, string>>): Promise<void> {
    const step = this.page.locator(".step").filter({ hasText: what });
    await step.locator("summary").click();
    for (const [name, value] of Object.entries(values)) await step.getByRole("textbox", { name }).fill(value);
    await step.getByRole("button", { name: en.save, exact: true }).click();
    await this.page.locator('.step[data-done="true"]').filter({ hasText: what }).waitFor();
  }

  /// All of the document, as the browser holds it.
  html(): Promise<string> {
    return this.page.evaluate(() => document.documentElement.outerHTML);
  }
}
