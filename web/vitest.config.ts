// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";
import WhatFailed from "./tests/what_failed";

const kHangMs = 900_000; // against hangs only, long enough for a wait to say what it saw instead

export default defineConfig({
  test: {
    reporters: ["default", new WhatFailed()],
    maxWorkers: 2, // processes of browser stories
    minWorkers: 1,
    projects: [
      {
        test: {
          name: "unit",
          include: ["tests/unit/**/*.test.ts"],
          environment: "happy-dom",
          setupFiles: ["tests/unit/clean_page.ts"],
          testTimeout: kHangMs,
          poolOptions: { forks: { isolate: false, singleFork: true } }, // a process for each file would take four times the processor time
        },
      },
      {
        test: {
          name: "browser",
          include: ["tests/browser/**/*.test.ts"],
          environment: "node",
          globalSetup: ["tests/browser/support/setup.ts"],
          testTimeout: kHangMs,
          hookTimeout: kHangMs,
          poolOptions: { forks: { isolate: false } },
        },
      },
    ],
  },
});
