// SPDX-License-Identifier: Apache-2.0
// A process of the program under test.
import { spawn, type ChildProcessWithoutNullStreams } from "node:child_process";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { until } from "./until";

export const projectFolder = resolve(dirname(fileURLToPath(import.meta.url)), "../../../..");
/// Where the program has scenes, hands and the built page from, as it finds them itself.
export const dataFolder = process.env["PHALANX_DATA_DIR"] ?? projectFolder;
const kBeginMs = 240_000;

/// Words of a command that starts the program given behind it, passes SIGINT on to it and ends as it does. "{clock}" in a word stands for a
/// file of the stage, the same for all programs of a stage: they share a clock then. Without a launcher all time passes more slowly.
const launcher = (process.env["PHALANX_LAUNCHER"] ?? "").split(" ").filter((word) => word !== "");

const pace = (withoutLauncher: number): number => Number(process.env["PHALANX_COCKPIT_SLOW_MOTION"] ?? (launcher.length > 0 ? 1 : withoutLauncher));

/// All time of a station and its device, time limits included, passes so many times more slowly, unless a launcher holds their clock: a
/// computer that also draws with its processor makes no faults of its own.
export const slowMotion = { alone: pace(4), wired: pace(20) }; // wired: two processes and a link between them

export function programPath(): string {
  return process.env["PHALANX_PROGRAM"] ?? resolve(projectFolder, "build/release/bin/phalanx");
}

/// @param clock  file of the clock, for a launcher
function start(args: readonly string[], folder: string, clock: string): ChildProcessWithoutNullStreams {
  const [command, ...words] = [...launcher.map((word) => word.replaceAll("{clock}", clock)), programPath(), ...args];
  return spawn(command!, words, { cwd: folder, detached: true }); // a process group of its own, with a launcher and helpers
}

const running = new Set<Program>();
process.once("disconnect", () => process.exit(1)); // the run that this process belongs to was killed
process.once("exit", () => running.forEach((program) => program.signal("SIGKILL")));

export class Program {
  output = "";
  errors = "";
  private readonly child: ChildProcessWithoutNullStreams;
  private readonly exit: Promise<void>;
  private gone = false;

  constructor(
    readonly args: readonly string[],
    folder: string,
    clock: string,
  ) {
    this.child = start(args, folder, clock);
    running.add(this);
    this.child.stdout.on("data", (data: Buffer) => (this.output += data.toString()));
    this.child.stderr.on("data", (data: Buffer) => (this.errors += data.toString()));
    this.exit = new Promise((done) => {
      this.child.on("error", (error) => {
        this.errors += `\n${error.message}`;
        this.leave();
        done();
      });
      // Not "exit": what it said last may come after it.
      this.child.on("close", () => {
        this.leave();
        done();
      });
    });
  }

  get ended(): boolean {
    return this.gone;
  }

  get code(): number | null {
    return this.child.exitCode;
  }

  /// What it says in its output, as soon as it has.
  line(pattern: RegExp): Promise<RegExpExecArray> {
    return until(
      `${pattern} of phalanx ${this.args.join(" ")}`,
      () => {
        const found = pattern.exec(this.output);
        if (!found && this.gone) throw new Error(`phalanx ${this.args.join(" ")} has ended: ${this.output}${this.errors}`);
        return found ?? undefined;
      },
      () => this.output + this.errors,
      kBeginMs,
    );
  }

  /// To the program, its launcher and its helpers.
  signal(name: NodeJS.Signals): void {
    if (this.gone || this.child.pid === undefined) return;
    try {
      process.kill(-this.child.pid, name);
    } catch {
      // it has ended meanwhile
    }
  }

  /// Ctrl-C, and what follows: torque to zero, and all that is still to be written.
  async end(): Promise<void> {
    if (!this.gone) this.child.kill("SIGINT");
    await this.exit;
  }

  /// At once, without a word.
  async kill(): Promise<void> {
    this.signal("SIGKILL");
    await this.exit;
  }

  private leave(): void {
    this.gone = true;
    running.delete(this);
  }
}

const kForgottenSeconds = 1800;

/// `phalanx run` with its page at 127.0.0.1. One whose test was killed ends by itself after half an hour.
export function runStation(folder: string, clock: string, slow: number, args: readonly string[]): Program {
  const limits = ["--slow-motion", String(slow), "--seconds", String(Math.ceil(kForgottenSeconds / slow))];
  return new Program(["run", ...args, "--no-realtime", "--quiet", ...limits], folder, clock);
}

/// `phalanx device simulate`: the exoskeleton's controller in a process of its own; likewise.
export function runDevice(folder: string, clock: string, slow: number, args: readonly string[]): Program {
  const limits = ["--slow-motion", String(slow), "--seconds", String(Math.ceil(kForgottenSeconds / slow))];
  return new Program(["device", "simulate", ...args, "--udp", "127.0.0.1:0", ...limits], folder, clock);
}

/// Where the page of a station is.
export async function addressOf(station: Program): Promise<{ url: string; port: number }> {
  const [, url, port] = await station.line(/Cockpit: (http:\/\/127\.0\.0\.1:(\d+)\/)/);
  return { url: url!, port: Number(port) };
}
