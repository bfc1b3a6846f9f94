// SPDX-License-Identifier: Apache-2.0
// The last words of a run: how long each file of the browser's took, and what failed, with the command that repeats it.
import { relative } from "node:path";
import type { Reporter, TestModule } from "vitest/node";

const seconds = (module: TestModule): number => {
  const { collectDuration, duration, setupDuration } = module.diagnostic();
  return (collectDuration + duration + setupDuration) / 1000;
};

export default class WhatFailed implements Reporter {
  onTestRunEnd(modules: readonly TestModule[]): void {
    const browser = modules.filter((module) => module.project.name === "browser");
    for (const module of [...browser].sort((a, b) => seconds(b) - seconds(a))) console.log(`${seconds(module).toFixed(1).padStart(6)} s  ${name(module)}`);
    for (const module of modules.filter((one) => !one.ok())) {
      const failed = [...module.children.allTests("failed")].map((test) => test.fullName);
      for (const what of failed.length > 0 ? failed : ["the file itself"]) console.log(`FAILED: ${name(module)} > ${what}`);
      console.log(`  again: cd web && ${settings()}npx vitest run --project ${module.project.name} ${name(module)}`);
    }
  }
}

/** What the tests were told by the environment, as a shell reads it. */
function settings(): string {
  const told = ["PHALANX_PROGRAM", "PHALANX_LAUNCHER"].filter((variable) => process.env[variable]);
  return told.map((variable) => `${variable}='${process.env[variable]}' `).join("");
}

function name(module: TestModule): string {
  return relative(module.project.config.root, module.moduleId);
}
