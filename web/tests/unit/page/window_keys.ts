// SPDX-License-Identifier: Apache-2.0
// The files of tests share a window: what one listens to ends with it.
import { afterAll, beforeAll } from "vitest";
import { listenToKeys, type KeyActions } from "../../../src/panels/keyboard";

/// listenToKeys() of the window, until the file ends.
export function listenInThisFile(actions: KeyActions): void {
  const added: Parameters<Window["addEventListener"]>[] = [];
  const source = {
    addEventListener: (...what: Parameters<Window["addEventListener"]>) => {
      added.push(what);
      window.addEventListener(...what);
    },
  };
  beforeAll(() => listenToKeys(source as Window, actions));
  afterAll(() => added.forEach((what) => window.removeEventListener(...what)));
}
