// SPDX-License-Identifier: Apache-2.0
// What the story of a device on a wire needs beside its pages: accounts, the commands of the registry, the calibration that the simulated
// device came with, and a controller that is powered on again at the same address.
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { addressOf, dataFolder, Program, programPath, runDevice, runStation, slowMotion } from "./support/program";

const kSeconds = "1800"; // after which a forgotten controller ends by itself
// The device's own patient squeezes every 6 s, and its hand is open for 1.2 s. While it is calibrated its time passes more slowly, so that the
// open hand is still for longer than the second that is measured. Twice as slow would be the fault sample_rate.
const kSlower = 1.8;
const kDegree = Math.PI / 180;
const store = ["--data", "data", "--keys", "config/keys"];

/// One account of a station with accounts.
export interface Account {
  readonly name: string;
  readonly role: "administrator" | "therapist" | "look_on" | "patient_screen";
}
export const accounts = {
  head: { name: "head", role: "administrator" },
  therapist: { name: "therapist", role: "therapist" },
  screen: { name: "screen", role: "patient_screen" },
} as const satisfies Record<string, Account>;
export const kPassword = "a password for a story";

/// A station with accounts, and a simulated controller on a wire.
export class DeviceStation {
  private constructor(
    readonly folder: string,
    private readonly clock: string,
    private readonly scene: readonly string[],
    private device: Program,
    readonly address: string,
    readonly station: Program,
    readonly url: string,
  ) {}

  /// Its device is slow: for a calibration.
  /// @param scene  name, and options that both programs get
  static async start(folder: string, scene: readonly string[]): Promise<DeviceStation> {
    const clock = join(folder, "clock");
    const slow = slowMotion.wired;
    command(folder, ["account", "add", accounts.head.name, "--role", accounts.head.role, ...store]);
    for (const { name, role } of [accounts.therapist, accounts.screen]) command(folder, ["account", "add", name, "--role", role, "--as", accounts.head.name, ...store]);
    const device = runDevice(folder, clock, kSlower * slow, scene);
    const address = (await device.line(/listening on (\S+)/))[1]!;
    writeFileSync(join(folder, "own.toml"), ownNumbers(command(folder, ["device", "probe", address])));
    const args = [...scene, "--device", address, "--port", "0", "--calibration", "own.toml", ...store];
    const station = runStation(folder, clock, slow, args);
    return new DeviceStation(folder, clock, scene, device, address, station, (await addressOf(station)).url);
  }

  /// Lets the clock of station and device pass so many times as fast as real time, at most, where a launcher holds it.
  setPace(pace: number): void {
    writeFileSync(`${this.clock}.pace`, String(pace));
  }

  /// Pulls the cable: nothing is sent and nothing heard any more.
  cut(): Promise<void> {
    return this.device.kill();
  }

  /// Powers the controller on again at the same address, with its own time.
  async plugIn(): Promise<void> {
    const own = ["device", "simulate", ...this.scene, "--udp", this.address.replace("udp:", ""), "--slow-motion", String(slowMotion.wired), "--seconds", kSeconds];
    this.device = new Program(own, this.folder, this.clock);
    await this.device.line(/listening on (\S+)/);
  }

  async end(): Promise<void> {
    await this.station.end();
    await this.device.end();
  }

  brief(): string {
    return [this.station, this.device].map((one) => `phalanx ${one.args[0]}${one.ended ? ", ended" : ""}: ${(one.output + one.errors).slice(-600)}`).join("\n");
  }
}

function command(folder: string, args: readonly string[]): string {
  const env = { ...process.env, PHALANX_DATA_DIR: dataFolder, PHALANX_PASSWORD: kPassword, PHALANX_NEW_PASSWORD: kPassword };
  return execFileSync(programPath(), args, { cwd: folder, env, stdio: "pipe" }).toString();
}

/// The calibration that a device came with: its own gains, from the ranges that `phalanx device probe` prints. What a therapist does not
/// measure keeps these numbers.
function ownNumbers(probed: string): string {
  const head = 'format = 2\ndevice = "simulated"\nserial = "simulated"\ndate = "2026-02-01T09:00:00Z"\nphalanx = "0.1.0"\n';
  const rows = [...probed.matchAll(/angle\s+(\w+)\s+(-?\d+) \.\.\s+(-?\d+)\s+(-?[\d.]+) \.\.\s+(-?[\d.]+) deg/g)];
  const channels = rows.map(([, joint, least, most, from, to]) => {
    const gain = (kDegree * (Number(to) - Number(from))) / (Number(most) - Number(least));
    const begin = kDegree * Number(from);
    const pose = `{ name = "smallest", raw = ${least}, value = ${begin}, residual_rad = 0 }`;
    return `\n[[channel]]\nkind = "angle"\njoint = "${joint}"\ngain = ${gain}\noffset = ${begin - gain * Number(least)}\nresidual_rad = 0\nmethod = "jig"\nposes = [${pose}]\n`;
  });
  return head + channels.join("");
}
