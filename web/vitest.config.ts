// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";

export default defineConfig({
  test: {
    fileParallelism: false, // two cores, and browsers with software rendering
    projects: [
      { test: { name: "unit", include: ["tests/unit/**/*.test.ts"], environment: "happy-dom" } },
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
