// SPDX-License-Identifier: Apache-2.0
// What a story needs, and its end: folders, stations, devices, pages of the browser. Everything is taken down when the file is through.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium, type Browser, type BrowserContextOptions, type Page } from "playwright-core";
import { afterAll, afterEach, expect, inject } from "vitest";
import { CockpitPage } from "./cockpit_page";
import { bringToKnownState, freeControl, type Values } from "./known_state";
import { addressOf, runDevice, runStation, slowMotion, type Program } from "./program";
import { PatientScreen } from "./patient_screen";
import { PatientsPage } from "./patients_page";
import { RecordingPage } from "./recording_page";
import { paintNothing, slowScreen } from "./slow_screen";
import type {} from "./setup"; // what it provides

export interface Station {
  readonly url: string;
}

export interface OwnStation extends Station {
  readonly program: Program;
  readonly port: number;
  readonly folder: string;
}

export interface OwnDevice {
  readonly program: Program;
  readonly address: string;
  readonly log: string;
}

export interface PageWishes extends BrowserContextOptions {
  readonly hertz?: number; // of its screen; else what the browser can
  readonly unseen?: boolean; // nothing in the 3D view is painted
}

/// All pixels, for pictures.
export const full: PageWishes = { viewport: { width: 1000, height: 640 } };
/// For stories that are not about looks: large enough to hold all controls, drawn with a quarter of the pixels, ten times a second.
export const small: PageWishes = { ...full, deviceScaleFactor: 0.5, hertz: 10 };
/// For stories that do not compare pictures of the 3D view: all of it is computed and none of it painted. Painting takes most of a page's time here.
export const unseen: PageWishes = { ...small, unseen: true };

const kDemonstration = "first_touch"; // the scene of a station that is told none
const kLastWords = 600; // characters

export class Stage {
  private readonly programs: Program[] = [];
  private readonly folders: string[] = [];
  private readonly pages: (CockpitPage | RecordingPage | PatientsPage | PatientScreen)[] = [];
  private browser: Promise<Browser> | undefined;
  private shared = "";

  /// The station that the stories of this process share, with a scene as its file has it, and values laid over its keys.
  async station(scene = kDemonstration, values: Values = {}): Promise<Station> {
    this.shared = `${inject("stations")}${process.env["VITEST_POOL_ID"] ?? "1"}`;
    const answer = await fetch(this.shared);
    const url = await answer.text();
    if (!answer.ok) throw new Error(url);
    await bringToKnownState(url, scene, values);
    return { url };
  }

  /// A page that has gone keeps control for a while, in case it comes back; this ends it.
  freeControl(station: Station): Promise<void> {
    return freeControl(station.url);
  }

  /// A station of the story's own, which it may kill. @param folder  where it runs; absent: a new one
  async ownStation(args: readonly string[] = [], port = 0, folder = this.folder()): Promise<OwnStation> {
    const program = this.add(runStation(folder, this.clock(), slowMotion.alone, [...args, "--port", String(port)]));
    return { program, ...(await addressOf(program)), folder };
  }

  /// A controller in a process of its own, with a row a tick in its log, and a station with it.
  /// @param values  laid over the scene's keys, of both
  async wired(scene: string, values: Values = {}, args: readonly string[] = []): Promise<{ device: OwnDevice; station: OwnStation }> {
    const slow = slowMotion.wired;
    const folder = this.folder();
    const set = Object.entries(values).flatMap(([key, value]) => ["--set", `${key}=${value}`]);
    const log = join(folder, "controller.csv");
    const controller = this.add(runDevice(folder, this.clock(), slow, [scene, "--log", log, ...set]));
    const address = (await controller.line(/listening on (\S+)/))[1]!;
    const program = this.add(runStation(folder, this.clock(), slow, [scene, "--device", address, "--port", "0", ...set, ...args]));
    return { device: { program: controller, address, log }, station: { program, ...(await addressOf(program)), folder } };
  }

  /// The page of a station in a browser profile of its own.
  async open(url: string, wishes: PageWishes = {}): Promise<CockpitPage> {
    const page = new CockpitPage(await this.blank(wishes));
    this.pages.push(page);
    await page.go(url);
    return page;
  }

  /// The page of a station that shows recordings. @param query  of its address
  async openRecordings(url: string, wishes: PageWishes = {}, query = ""): Promise<RecordingPage> {
    const page = new RecordingPage(await this.blank(wishes));
    this.pages.push(page);
    await page.page.goto(`${url}recording.html${query}`);
    return page;
  }

  /// The page of patients of a station.
  async openPatients(url: string, wishes: PageWishes = {}): Promise<PatientsPage> {
    const page = new PatientsPage(await this.blank(wishes));
    this.pages.push(page);
    await page.page.goto(`${url}people.html`);
    return page;
  }

  /// The patient's screen of a station, without speech and sound.
  async openPatientScreen(url: string, wishes: PageWishes = {}): Promise<PatientScreen> {
    const screen = new PatientScreen(await this.blank(wishes));
    this.pages.push(screen);
    await screen.page.goto(`${url}patient.html?lang=en&speech=0&sound=0`);
    return screen;
  }

  private async blank({ hertz, unseen: blind = false, ...options }: PageWishes): Promise<Page> {
    this.browser ??= chromium.connect(inject("browser"));
    const browser = await this.browser;
    const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, colorScheme: "dark", reducedMotion: "reduce", ...options });
    if (hertz !== undefined) await context.addInitScript(slowScreen, hertz);
    if (blind) await context.addInitScript(paintNothing);
    return context.newPage();
  }

  /// What every page knew last, and the last words of every program.
  async brief(): Promise<string> {
    const pages = this.pages.map((page, i) => `page ${i + 1}: ${page.brief()}`);
    const programs = this.programs.map((program) => `phalanx ${program.args[0]}${program.ended ? ", ended" : ""}: ${(program.output + program.errors).slice(-kLastWords)}`);
    const shared = this.shared === "" ? [] : [`the shared station: ${await (await fetch(`${this.shared}/words`)).text()}`];
    return [...pages, ...programs, ...shared].join("\n");
  }

  async close(): Promise<void> {
    const errors = this.pages.flatMap((page) => page.errors);
    await (await this.browser?.catch(() => undefined))?.close();
    for (const program of this.programs) await program.kill();
    for (const folder of this.folders) rmSync(folder, { recursive: true, force: true });
    expect(errors, "exceptions that nobody caught in a page").toEqual([]);
  }

  private folder(): string {
    const made = mkdtempSync(join(tmpdir(), "phalanx-cockpit-"));
    this.folders.push(made);
    return made;
  }

  /// Of all programs of this stage.
  private clock(): string {
    return join(this.folders[0] ?? this.folder(), "clock");
  }

  private add(program: Program): Program {
    this.programs.push(program);
    return program;
  }
}

/// One for a file of stories.
export function stage(): Stage {
  const made = new Stage();
  afterEach(async ({ task }) => {
    if (task.result?.state === "fail") console.log(`when "${task.name}" failed:\n${await made.brief()}`);
  });
  afterAll(() => made.close());
  return made;
}
