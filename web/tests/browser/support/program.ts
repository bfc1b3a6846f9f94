// SPDX-License-Identifier: Apache-2.0
// A process of the program under test.
import { spawn, type ChildProcessWithoutNullStreams } from "node:child_process";
import { dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { pause, until } from "./until";

export const projectFolder = resolve(dirname(fileURLToPath(import.meta.url)), "../../../..");
/// Where the program has scenes, hands and the built page from, as it finds them itself.
export const dataFolder = process.env["PHALANX_DATA"] ?? projectFolder;
const kBeginMs = 240_000;
const kEndMs = 120_000; // for the ramp to zero and all that is still to be written

export function programPath(): string {
  return process.env["PHALANX_PROGRAM"] ?? resolve(projectFolder, "build/release/bin/phalanx");
}

export class Program {
  output = "";
  errors = "";
  private readonly child: ChildProcessWithoutNullStreams;
  private readonly exit: Promise<void>;
  private gone = false;

  constructor(
    readonly args: readonly string[],
    folder: string,
  ) {
    this.child = spawn(programPath(), [...args], { cwd: folder });
    this.child.stdout.on("data", (data: Buffer) => (this.output += data.toString()));
    this.child.stderr.on("data", (data: Buffer) => (this.errors += data.toString()));
    this.exit = new Promise((done) => {
      this.child.on("error", (error) => {
        this.errors += `\n${error.message}`;
        this.gone = true;
        done();
      });
      this.child.on("exit", () => {
        this.gone = true;
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

  signal(name: NodeJS.Signals): void {
    this.child.kill(name);
  }

  /// Ctrl-C; if that does not help, the hard way.
  async end(): Promise<void> {
    if (this.gone) return;
    this.child.kill("SIGINT");
    await Promise.race([this.exit, pause(kEndMs)]);
    if (!this.gone) await this.kill();
  }

  /// At once, without a word.
  async kill(): Promise<void> {
    if (!this.gone) this.child.kill("SIGKILL");
    await this.exit;
  }
}
