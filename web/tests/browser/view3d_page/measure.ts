// SPDX-License-Identifier: Apache-2.0
// Frames a second at each quality and at the one that it finds itself. Not a test: prints what it measured here and now.
// npx vite-node tests/browser/view3d_page/measure.ts [RECORDING]
import { readdirSync, readFileSync } from "node:fs";
import { launch } from "./browser";
import { serve } from "./server";

/// Processor time of this program's browser so far, by kind of process [s]: what a frame costs, however busy the machine is.
function processorTime(): Map<string, number> {
  const processes = new Map<number, { parent: number; kind: string; seconds: number }>();
  for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const kind = /--type=([a-z-]+)/.exec(readFileSync(`/proc/${id}/cmdline`, "utf8"))?.[1] ?? "";
      const fields = readFileSync(`/proc/${id}/stat`, "utf8").split(") ").at(-1)!.split(" ");
      processes.set(Number(id), { parent: Number(fields[1]), kind, seconds: (Number(fields[11]) + Number(fields[12])) / 100 });
    } catch {
      // it has ended meanwhile
    }
  }
  const isOurs = (id: number): boolean => id === process.pid || (id > 1 && isOurs(processes.get(id)?.parent ?? 0));
  const sum = new Map<string, number>();
  for (const [id, { kind, seconds }] of processes) if (kind && isOurs(id)) sum.set(kind, (sum.get(kind) ?? 0) + seconds);
  return sum;
}

const recording = process.argv[2] ?? "grasp_teapot,skin";
const { server, url } = await serve();
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
for (const quality of ["3", "2", "1", "0", ""]) {
  await page.goto(quality === "" ? url : `${url}?quality=${quality}`);
  await page.waitForFunction(() => window.viewPage !== undefined);
  await page.evaluate(async (name) => {
    await window.viewPage.load(name);
    await window.viewPage.play(name, 60);
    await new Promise((done) => setTimeout(done, 4000)); // shaders are compiled
  }, recording);
  const before = processorTime();
  const found = await page.evaluate(async () => {
    const before = window.viewPage.view.probe().frames;
    const began = performance.now();
    await new Promise((done) => setTimeout(done, 5000));
    const probe = window.viewPage.view.probe();
    return { level: probe.quality, frames: probe.frames - before, rate: ((probe.frames - before) * 1000) / (performance.now() - began), own: probe.framesPerSecond };
  });
  const after = processorTime();
  const cost = ["gpu-process", "renderer"].map((kind) => `${kind} ${((1000 * ((after.get(kind) ?? 0) - (before.get(kind) ?? 0))) / found.frames).toFixed(0)} ms`);
  console.log(`quality ${quality || "its own"}: level ${found.level}, ${found.rate.toFixed(1)} frames/s (it says ${found.own}); a frame costs ${cost.join(", ")}`);
}
await browser.close();
await server.close();
