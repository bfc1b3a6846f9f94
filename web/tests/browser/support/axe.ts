// SPDX-License-Identifier: Apache-2.0
// What axe-core finds wrong with a page for people who use a keyboard, a screen reader or magnified type.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import type { RunOnly } from "axe-core";
import type { Page } from "playwright-core";
import { projectFolder } from "./program";

declare global {
  interface Window {
    axe: typeof import("axe-core");
  }
}

const source = readFileSync(join(projectFolder, "web/node_modules/axe-core/axe.min.js"), "utf8");
/// WCAG 2.0, 2.1 and 2.2, levels A and AA, and what axe-core calls best practice. None of these rules is left out.
export const allRules: RunOnly = { type: "tag", values: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"] };
/// Those whose result depends on the theme.
export const colourRules: RunOnly = { type: "rule", values: ["color-contrast", "link-in-text-block"] };

/// Brings axe-core into the page as the tests' own code, which the page's Content-Security-Policy does not hold up. A script element would
/// be refused.
export async function bringAxe(page: Page): Promise<void> {
  await page.evaluate(source);
}

/// @returns rule, element and reason of each violation
export function violations(page: Page, runOnly: RunOnly): Promise<string[]> {
  return page.evaluate(async (rules) => {
    const found = await window.axe.run(document, { runOnly: rules, resultTypes: ["violations"] });
    return found.violations.flatMap(({ id, nodes }) => nodes.map((node) => `${id}: ${node.target.join(" ")}: ${node.failureSummary}`));
  }, runOnly);
}
