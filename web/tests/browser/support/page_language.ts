// SPDX-License-Identifier: Apache-2.0
import type { BrowserContext } from "playwright-core";
import { kLanguageKey, type Language } from "../../../src/strings";

/// Pages of this context open in the language, as if a person had chosen it before.
export function rememberLanguage(context: BrowserContext, { code }: Language): Promise<void> {
  return context.addInitScript(([key, value]) => localStorage.setItem(key, value), [kLanguageKey, code] as const);
}
