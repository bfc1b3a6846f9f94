// SPDX-License-Identifier: Apache-2.0
import { chromium, type Browser } from "playwright-core";
import { browserOptions } from "../support/browser";

/// A browser of its own, for programs that are no tests.
export function launch(): Promise<Browser> {
  return chromium.launch(browserOptions);
}
