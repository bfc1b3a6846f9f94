// SPDX-License-Identifier: Apache-2.0
// A station that is none: plays a recording and says what it is told to say, so that every state of the page can be looked at.
import { readFileSync, readdirSync } from "node:fs";
import { createServer, type Server } from "node:http";
import { dirname, extname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { create, fromBinary, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import type { Page, WebSocketRoute } from "playwright-core";
import {
  ChangeKind,
  HandSource,
  KeyInfoSchema,
  KeyType,
  NoticeSchema,
  NumberRangeSchema,
  StateSchema,
  ToHostSchema,
  ToPageSchema,
  WelcomeSchema,
  type KeyInfo,
  type State,
  type ToHost,
} from "../../src/gen/phalanx/cockpit_pb";
import { GeometrySchema, type Geometry } from "../../src/gen/phalanx/geometry_pb";
import { OpeningSchema, SafetyState, TickSchema, type Tick } from "../../src/gen/phalanx/tick_pb";
import { strings } from "../../src/strings";
import { kProtocol } from "../../src/wire/connection";
import { recording } from "./view3d_page/server";

const here = dirname(fileURLToPath(import.meta.url));
const root = resolve(here, "../../..");
const kPeriodMs = 1000 / 60;

/// Bounds as docs/scenes.md writes them: "> 0, <= 15", ">= -1000000, < 0, or -inf".
function rangeOfDocs(text: string): MessageInitShape<typeof NumberRangeSchema> {
  const parts = text.split(", ");
  const bound = (sign: string) => parts.find((part) => part.startsWith(sign))?.split(" ");
  const lower = bound(">");
  const upper = bound("<");
  return {
    min: Number(lower?.[1] ?? -Infinity), max: Number(upper?.[1] ?? Infinity),
    minOpen: lower?.[0] === ">", maxOpen: upper?.[0] === "<", minusInfinity: parts.includes("or -inf"),
  };
}

/// The kinds that a meaning begins with, "(bottle cup) outer diameter; default of cup 75", with their defaults.
function kindsOfDocs(meaning: string, defaultValue: string): { kind: string; defaultValue: string }[] {
  if (!meaning.startsWith("(")) return [];
  const own = new Map((meaning.split("; default of ")[1] ?? "").split(/, (?=[a-z])/).map((one) => [one.slice(0, one.indexOf(" ")), one.slice(one.indexOf(" ") + 1)]));
  return meaning.slice(1, meaning.indexOf(")")).split(" ").map((kind) => ({ kind, defaultValue: own.get(kind) ?? defaultValue }));
}

/// A meaning without the kinds and their defaults.
const plain = (meaning: string) => meaning.slice(meaning.startsWith("(") ? meaning.indexOf(")") + 2 : 0).split("; default of ")[0]!;

/// The words of docs/scenes.md for what a change needs.
const changeOfDocs: Readonly<Record<string, ChangeKind>> = {
  "at once": ChangeKind.CHANGE_IN_CONTACT,
  "at zero torque": ChangeKind.CHANGE_AT_ZERO_TORQUE,
  "another object": ChangeKind.CHANGE_OTHER_OBJECT,
  "new station": ChangeKind.CHANGE_NEW_STATION,
};

/// The keys as docs/scenes.md lists them.
export function keysOfDocs(): KeyInfo[] {
  const lines = readFileSync(join(root, "docs/scenes.md"), "utf8").split("\n");
  const bare = (text: string) => text.trim().replace(/^`(.*)`$/, "$1");
  return lines
    .filter((line) => /^\| `[a-z0-9_.[\]]+` \| (number|integer|flag|text|choice|vector|file|name)/.test(line))
    .map((line) => {
      const [path, typeName, unit, range, value, changeName, meaning] = line.split("|").slice(1).map((cell) => bare(cell));
      const type: KeyType = strings.settings.types.indexOf(typeName!);
      const numeric = [KeyType.KEY_NUMBER, KeyType.KEY_NUMBER_OR_OFF, KeyType.KEY_INTEGER, KeyType.KEY_VECTOR].includes(type);
      return create(KeyInfoSchema, {
        path: path!, type, unit: unit!, defaultValue: value!, meaning: plain(meaning!),
        ...(numeric ? { range: rangeOfDocs(range!) } : {}),
        choice: type === KeyType.KEY_CHOICE ? range!.split(", ") : [],
        kind: path!.startsWith("objects[].") ? kindsOfDocs(meaning!, value!) : [],
        change: changeOfDocs[changeName!]!,
      });
    });
}

const types: Readonly<Record<string, string>> = {
  ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml",
};

/// The built page with the headers that the station sends.
export async function serveSite(folder = process.env["PHALANX_SITE"] ?? join(here, "../../dist")): Promise<{ server: Server; url: string }> {
  const server = createServer((request, response) => {
    const path = new URL(request.url ?? "/", "http://x").pathname;
    try {
      const body = readFileSync(join(folder, path === "/" ? "index.html" : path));
      response.writeHead(200, {
        "Content-Type": types[extname(path) || ".html"] ?? "application/octet-stream",
        "Content-Security-Policy":
          "default-src 'self'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; frame-ancestors 'none'",
      });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise<void>((ready) => server.listen(0, "127.0.0.1", ready));
  const address = server.address();
  return { server, url: `http://127.0.0.1:${typeof address === "object" && address ? address.port : 0}/` };
}

export class FakeHost {
  readonly state: State;
  readonly asked: ToHost[] = [];
  refuse = ""; // the next changes are refused in these words
  page = 2;
  mayOperate = true;
  shaking = false;
  touching = true;
  silent: readonly number[] = []; // digits that began inside the object
  playing = true;
  down = false;
  geometryOf: Geometry;
  import_: unknown = null;
  private readonly ticks: readonly Tick[];
  private socket: WebSocketRoute | null = null;
  private timer: ReturnType<typeof setInterval> | undefined;
  private step = 0;
  private readonly began = Date.now();
  private readonly utcOffset = this.began / 1000; // UTC minus the ticks' clock [s]

  /// The poses of an open hand and of a closed one.
  hands(): { hand: number[]; target: number[] } {
    const closed = this.ticks[Math.floor(this.ticks.length / 2)];
    return { hand: this.ticks[0]?.gdpPose ?? [], target: closed?.gdpPose ?? [] };
  }

  constructor(name = "grasp_teapot,skin") {
    const played = recording(name);
    this.ticks = played.ticks;
    const limits = (flexion: number, spread: number, hinge: number) => Array.from({ length: 20 }, (_, i) => [flexion, spread, hinge, hinge][i % 4]!);
    this.geometryOf = create(GeometrySchema, {
      ...played.geometry,
      jointName: Array.from({ length: 20 }, (_, i) => `joint_${i}`),
      jointMin: limits(-0.35, -0.35, 0), jointMax: limits(1.57, 0.35, 1.75), jointOpen: limits(0, 0, 0),
    });
    const octave = Array.from({ length: 27 }, (_, k) => BigInt(Math.round(40000 * Math.exp(-((k - 9) ** 2) / 3)) + (k === 15 ? 2 : 0)));
    this.state = create(StateSchema, {
      operatorPage: 2, operatorName: "Anna", pages: 3, scene: "grasp_teapot",
      sceneDescription: "the right hand closes on the Utah teapot, the papers' object",
      value: [
        { key: "objects.0.kind", value: '"teapot"' }, { key: "objects.0.size_mm", value: "100" },
        { key: "force.stiffness_n_per_mm", value: "0.5" }, { key: "objects.0.position_mm", value: "[0, 0, 0]" },
      ],
      geometry: 1, safety: SafetyState.SAFETY_RUNNING, source: HandSource.HAND_PATIENT, deviceSpec: "simulated",
      deviceName: "Beihang exoskeleton", deviceSerial: "SIM-0001", deviceSimulated: true, rendersTorque: true, deviceState: "active",
      sensedJoint: [0, 1, 2, 3, 4, 5, 6, 7], // of thumb and index finger: the others follow, as on the device of ./run
      realtime: "SCHED_FIFO 80, memory locked",
      link: { received: 118230n, lost: 0n, corrupt: 0n, refused: 0n, outdated: 0n, sent: 118229n },
      loop: {
        period: 0.005, steps: 118230n, overruns: 0n, skipped: 0n,
        lateness: { p50Us: 54, p99Us: 121, p999Us: 210, maxUs: 1210, octave },
        step: { p50Us: 88.4, p99Us: 190, p999Us: 260, maxUs: 2310, octave: octave.map((_, k) => octave[Math.max(0, k - 1)]!) },
      },
    });
  }

  async attach(page: Page): Promise<void> {
    await page.routeWebSocket("**/stream", (socket) => {
      if (this.down) return void socket.close();
      this.socket = socket;
      socket.onMessage((data) => typeof data !== "string" && this.received(fromBinary(ToHostSchema, new Uint8Array(data))));
      socket.onClose(() => this.hush());
    });
    await page.route("**/geometry/*", (route) =>
      route.fulfill({ body: Buffer.from(toBinary(GeometrySchema, this.geometryOf)), contentType: "application/octet-stream" }));
    await page.route("**/mesh?*", (route) => route.fulfill({ status: 200, contentType: "application/json", body: JSON.stringify(this.import_) }));
    await page.route("**/stop", (route) => route.fulfill({ status: 200, body: "stopped" }));
  }

  send(what: NonNullable<MessageInitShape<typeof ToPageSchema>["what"]>): void {
    this.socket?.send(Buffer.from(toBinary(ToPageSchema, create(ToPageSchema, { what }))));
  }

  say(): void {
    this.state.time = (Date.now() - this.began) / 1000;
    this.send({ case: "state", value: this.state });
  }

  /// The ticks' clock [s]: slower than the computer's where it is busy.
  private get clock(): number {
    return (this.step * kPeriodMs) / 1000;
  }

  notice(level: number, who: string, code: string, text: string): void {
    this.send({ case: "notice", value: create(NoticeSchema, { level, who, code, text, unixTime: this.utcOffset + this.clock }) });
  }

  /// The line breaks, and stays so.
  async cut(): Promise<void> {
    this.down = true;
    this.hush();
    await this.socket?.close({ code: 1006 }).catch(() => this.socket?.close());
  }

  hush(): void {
    clearInterval(this.timer);
    this.timer = undefined;
  }

  private received(message: ToHost): void {
    this.asked.push(message);
    const what = message.what;
    let error = "";
    if (what.case === "hello") return this.welcome();
    if (what.case === "set") error = this.refuse || this.set(what.value.setting);
    if (what.case === "stop") Object.assign(this.state, { heldStopped: true, safety: SafetyState.SAFETY_STOPPED, stops: this.state.stops + 1n });
    if (what.case === "resume") Object.assign(this.state, { heldStopped: false, safety: SafetyState.SAFETY_RUNNING });
    if (what.case === "take") this.state.operatorPage = this.page;
    if (what.case === "source") {
      this.state.source = what.value.source;
      this.state.slider = what.value.source === HandSource.HAND_SLIDERS ? new Array<number>(20).fill(0.2) : [];
    }
    if (what.case === "sliders") this.state.slider = what.value.angle;
    if (what.case === "scene") Object.assign(this.state, { scene: what.value.name, changed: [] });
    if (message.request !== 0) this.send({ case: "reply", value: { $typeName: "phalanx.wire.Reply", request: message.request, ok: error === "", error } });
    this.say();
  }

  private set(settings: readonly { key: string; value: string }[]): string {
    for (const { key, value } of settings) {
      for (const list of [this.state.changed, this.state.value]) {
        const at = list.findIndex((one) => one.key === key);
        if (at >= 0) list.splice(at, 1);
        if (value !== "") list.push({ $typeName: "phalanx.wire.Setting", key, value });
      }
    }
    return "";
  }

  private welcome(): void {
    const scenes = readdirSync(join(root, "scenes")).filter((name) => name.endsWith(".toml")).map((name) => name.slice(0, -5));
    this.send({
      case: "welcome",
      value: create(WelcomeSchema, {
        protocol: kProtocol, version: "0.7.0", page: this.page, secret: "s3cret", mayOperate: this.mayOperate, key: keysOfDocs(),
        scene: scenes.map((name) => ({ name, meaning: `${name.replaceAll("_", " ")}, as shipped`, purpose: /^(bench|timing|stability)_|^wave$/.test(name) ? "benchmark" : "exercise" })),
        profile: ["large-man", "small-woman", "stiff-hand"].map((name) => ({ name, meaning: name })),
        past: [
          { level: 0, unixTime: Date.now() / 1000 - 60, who: "", code: "began", text: "The station began: grasp_teapot, simulated patient." },
          { level: 1, unixTime: Date.now() / 1000 - 30, who: "page 2 (127.0.0.1), Anna", code: "set", text: "force.stiffness_n_per_mm = 0.5" },
        ],
        unixTime: this.utcOffset + this.clock,
        clock: this.clock,
        viewerUrl: this.mayOperate ? ["https://192.0.2.7:8480/?token=Q3mYf0aLr8sVn2kTzB7w1A"] : [],
      }),
    });
    this.say();
    this.hush();
    this.timer = setInterval(() => (this.playing || this.state.wizard) && this.tick(), kPeriodMs);
  }

  private tick(): void {
    if (++this.step % 30 === 0) this.say();
    if (!this.playing) return; // a calibration sends no steps
    const time = this.clock;
    const length = this.ticks.length;
    const at = this.touching ? Math.round(Math.abs(((time * 130 + 0.45 * length) % (2 * 0.55 * length)) - 0.55 * length) * 0.35 + 0.4 * length) : 20;
    const source = this.ticks[Math.min(length - 1, at)]!;
    const swing = this.shaking ? 0.6 * Math.sin(2 * Math.PI * 11 * time) : 0;
    const flexion = 0.5 + 0.3 * Math.sin(time);
    const stopped = this.state.safety !== SafetyState.SAFETY_RUNNING;
    this.send({
      case: "tick",
      value: create(TickSchema, {
        ...source,
        tick: BigInt(this.step), time, factor: stopped ? 0 : 1, atRest: stopped, state: this.state.safety, opening: this.silent.map((digit) => create(OpeningSchema, { digit, way: 0.014 })),
        hcpAngle: Array.from({ length: 20 }, (_, i) => (i % 4 === 1 ? 0.05 : flexion * (1 - 0.02 * i)) + 0.05),
        gdpAngle: Array.from({ length: 20 }, (_, i) => (i % 4 === 1 ? 0.05 : Math.min(flexion * (1 - 0.02 * i), 0.6))),
        torque: Array.from({ length: 20 }, (_, i) => (stopped ? 0 : 0.02 * Math.sin(time + i))),
        contact: source.contact.map((contact) => ({
          ...contact,
          force: Math.max(0, contact.force + swing), forceRaw: Math.max(0, contact.forceRaw + 1.6 * swing),
          oscillating: this.shaking, frequency: 11, swing: 1.2,
        })),
      }),
    });
  }
}
