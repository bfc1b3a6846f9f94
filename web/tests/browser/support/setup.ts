// SPDX-License-Identifier: Apache-2.0
// Once for all stories: one browser, and for each process of stories one station that they share, started when the first of them asks.
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";
import type { TestProject } from "vitest/node";
import { browserOptions } from "./browser";
import { addressOf, runStation, slowMotion, type Program } from "./program";

declare module "vitest" {
  export interface ProvidedContext {
    browser: string; // its address, for chromium.connect()
    stations: string; // GET NAME: the address of that station's page; GET NAME/words: its last words
  }
}

const kLastWords = 600; // characters

class SharedStations {
  private readonly folder = mkdtempSync(join(tmpdir(), "phalanx-cockpit-"));
  private readonly stations = new Map<string, Program>();
  private readonly server = createServer((request, response) => {
    const [name, what] = (request.url ?? "").slice(1).split("/");
    this.answer(name!, what).then(
      (text) => response.end(text),
      (error: unknown) => response.writeHead(500).end(String(error)),
    );
  });

  async listen(): Promise<string> {
    await new Promise<void>((ready) => this.server.listen(0, "127.0.0.1", ready));
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}/`;
  }

  /// @throws Error if a station did not run until now, or did not end as it should
  async close(): Promise<void> {
    this.server.close();
    const gone = [...this.stations.values()].filter((program) => program.ended);
    await Promise.all([...this.stations.values()].map((program) => program.end()));
    rmSync(this.folder, { recursive: true, force: true });
    for (const program of gone) throw new Error(`a station that stories share ended before them: ${program.output}${program.errors}`);
    for (const { code, output, errors } of this.stations.values()) {
      if (code !== 0) throw new Error(`a station that stories share ended with code ${code}: ${output}${errors}`);
    }
  }

  private async answer(name: string, what: string | undefined): Promise<string> {
    const station = this.stations.get(name) ?? runStation(this.folder, join(this.folder, `clock_${name}`), slowMotion.alone, ["--port", "0"]);
    this.stations.set(name, station);
    if (what === "words") return (station.output + station.errors).slice(-kLastWords);
    return (await addressOf(station)).url;
  }
}

export default async function setup(project: TestProject): Promise<() => Promise<void>> {
  const browser = await chromium.launchServer(browserOptions);
  const stations = new SharedStations();
  project.provide("browser", browser.wsEndpoint());
  project.provide("stations", await stations.listen());
  return async () => {
    await browser.close();
    await stations.close();
  };
}
