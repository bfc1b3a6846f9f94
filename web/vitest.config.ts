// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";

export default defineConfig({
  test: {
    fileParallelism: false, // two cores, and browsers with software rendering
    projects: [
      {
        test: {
          name: "unit",
          include: ["tests/unit/**/*.test.ts"],
          environment: "happy-dom",
          setupFiles: ["tests/unit/clean_page.ts"],
          testTimeout: 900_000, // against hangs only
          poolOptions: { forks: { isolate: false, singleFork: true } }, // a process for each file would take four times the processor time
        },
      },
      {
        test: {
          name: "browser",
          include: ["tests/browser/**/*.test.ts"],
          environment: "node",
          testTimeout: 120_000,
          hookTimeout: 120_000,
        },
      },
    ],
  },
});
