// SPDX-License-Identifier: Apache-2.0
// What a story needs, and its end: folders, stations, devices, a browser. Everything is taken down when the file is through.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium, type Browser, type BrowserContextOptions } from "playwright-core";
import { afterAll, afterEach, expect, vi } from "vitest";
import { CockpitPage } from "./cockpit_page";
import { Program, projectFolder } from "./program";

/// All time of a station and its device, time limits included, passes so many times more slowly: a computer that also draws with its
/// processor makes no faults of its own.
export const slowMotion = process.env["PHALANX_COCKPIT_SLOW_MOTION"] ?? "4";

export interface StationWishes {
  readonly scene?: string;
  readonly args?: readonly string[];
  readonly port?: number; // 0: any
  readonly slow?: string;
}

export interface Station {
  readonly program: Program;
  readonly url: string;
  readonly port: number;
  readonly folder: string;
}

export interface OwnDevice {
  readonly program: Program;
  readonly address: string;
  readonly log: string;
}

/// Large enough to hold all controls, small enough for several pages drawn by a processor.
export const small: BrowserContextOptions = { viewport: { width: 1000, height: 640 } };

const kTestMs = 900_000; // of a whole test; only against hangs, as all limits here, and long enough for a wait to say what it saw instead

const kLastWords = 600; // characters

/// A program whose test was killed ends by itself after half an hour; its clock is the slowed one.
const forgotten = (slow: string) => ["--seconds", String(Math.ceil(1800 / Number(slow)))];

const browserFlags = [
  "--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--no-first-run", "--mute-audio",
];

export class Stage {
  private readonly programs: Program[] = [];
  private readonly folders: string[] = [];
  private readonly pages: CockpitPage[] = [];
  private browser: Promise<Browser> | undefined;

  folder(): string {
    const made = mkdtempSync(join(tmpdir(), "phalanx-cockpit-"));
    this.folders.push(made);
    return made;
  }

  /// `phalanx run` with its page, in a folder of its own.
  async station(wishes: StationWishes = {}): Promise<Station> {
    const folder = this.folder();
    const slow = wishes.slow ?? slowMotion;
    const program = this.run(folder, [
      "run", ...(wishes.scene ? [wishes.scene] : []), "--no-realtime", "--quiet", "--port", String(wishes.port ?? 0), "--slow-motion", slow,
      ...forgotten(slow), ...(wishes.args ?? []),
    ]);
    const [, url, port] = await program.line(/Cockpit: (http:\/\/127\.0\.0\.1:(\d+)\/)/);
    return { program, url: url!, port: Number(port), folder };
  }

  /// `phalanx device simulate`: the exoskeleton's controller as a process of its own, with a row a tick in its log.
  async device(scene: string, args: readonly string[] = [], slow = slowMotion): Promise<OwnDevice> {
    const folder = this.folder();
    const log = join(folder, "controller.csv");
    const program = this.run(folder, ["device", "simulate", scene, "--udp", "127.0.0.1:0", "--log", log, "--slow-motion", slow, ...forgotten(slow), ...args]);
    const [, address] = await program.line(/listening on (\S+)/);
    return { program, address: address!, log };
  }

  /// The page of a station in a browser profile of its own.
  async open(url: string, options: BrowserContextOptions = {}): Promise<CockpitPage> {
    this.browser ??= chromium.launch({ executablePath: join(projectFolder, "web/tests/browser/support/chromium.sh"), args: browserFlags });
    const browser = await this.browser;
    const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme: "dark", ...options });
    const page = new CockpitPage(await context.newPage());
    this.pages.push(page);
    await page.go(url);
    return page;
  }

  /// What every page knew last, and the last words of every program.
  brief(): string {
    const pages = this.pages.map((page, i) => `page ${i + 1}: ${page.brief()}`);
    const programs = this.programs.map((program) => `phalanx ${program.args[0]}${program.ended ? ", ended" : ""}: ${(program.output + program.errors).slice(-kLastWords)}`);
    return [...pages, ...programs].join("\n");
  }

  async close(): Promise<void> {
    const errors = this.pages.flatMap((page) => page.errors);
    await (await this.browser?.catch(() => undefined))?.close();
    for (const program of this.programs) await program.end();
    for (const folder of this.folders) rmSync(folder, { recursive: true, force: true });
    expect(errors, "exceptions that nobody caught in a page").toEqual([]);
  }

  private run(folder: string, args: readonly string[]): Program {
    const program = new Program(args, folder);
    this.programs.push(program);
    return program;
  }
}

/// One for a file of stories.
export function stage(): Stage {
  vi.setConfig({ testTimeout: kTestMs, hookTimeout: kTestMs });
  const made = new Stage();
  afterEach(({ task }) => {
    if (task.result?.state === "fail") console.log(`when "${task.name}" failed:\n${made.brief()}`);
  });
  afterAll(() => made.close());
  return made;
}
