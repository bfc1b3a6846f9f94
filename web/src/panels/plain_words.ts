// SPDX-License-Identifier: Apache-2.0
// The station's texts in the words of the page: labels in place of keys, and files without their folders.
import { strings } from "../strings";

const labels = strings.settings.labels;

/// @param path  "force.law", "objects[].kind" or "objects.0.kind"  @returns its label; a key without a label stays as it is
export function settingLabel(path: string): string {
  return labels[path.replace(/^objects\.\d+\./, "objects[].")] ?? path;
}

const kKey = /(?<![\w./-])[a-z]+(?:\.(?:\d+\.)?[a-z0-9_]+)+(?![\w/.-]*\w)/g; // force.law; neither grasp.toml in a path nor example.org/x
const kFolders = /(?<![\w:/])(?:[\w.~-]*\/)+([\w.-]+\.\w+)/g;

/// @returns the text with labels in quotation marks for keys, and the last part of each path of a file
export function plainWords(text: string): string {
  const named = text.replace(kKey, (key) => (settingLabel(key) === key ? key : strings.quoted(settingLabel(key))));
  return named.replace(kFolders, "$1");
}
