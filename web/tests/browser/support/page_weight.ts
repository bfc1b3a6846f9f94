// SPDX-License-Identifier: Apache-2.0
// Scripts and style sheets of the built pages, with what they load later.
import { readFileSync, readdirSync } from "node:fs";
import { basename, join } from "node:path";
import { gzipSync } from "node:zlib";

/// @param site  folder of the built front-end  @param pages  names of HTML files
/// @returns the paths of every script and style sheet that these pages name, directly or through others
export function filesOf(site: string, pages: readonly string[]): readonly string[] {
  const all = new Map(readdirSync(site, { recursive: true }).map(String).filter((name) => /\.(js|css)$/.test(name)).map((name) => [basename(name), name]));
  const found = new Set<string>();
  const read = (name: string) => {
    for (const [named] of readFileSync(join(site, name), "utf8").matchAll(/[\w.-]+\.(?:js|css)\b/g)) {
      const file = all.get(named);
      if (file === undefined || found.has(file)) continue;
      found.add(file);
      read(file);
    }
  };
  pages.forEach(read);
  return [...found];
}

/// Bytes of the files, gzipped.
export const weightOf = (site: string, files: readonly string[]): number => files.reduce((sum, name) => sum + gzipSync(readFileSync(join(site, name)), { level: 9 }).length, 0);
