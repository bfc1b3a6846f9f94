// SPDX-License-Identifier: Apache-2.0
// The WebSocket to the station. It sends hello, keeps the page's secret, numbers requests, and reconnects by itself.
import { create, fromBinary, toBinary } from "@bufbuild/protobuf";
import { HelloSchema, SeenSchema, ToHostSchema, ToPageSchema, type ToHost, type ToPage } from "../gen/phalanx/cockpit_pb";

export const kProtocol = 3; // Cockpit::kProtocol

/// connecting: no Welcome yet; open: it has arrived; waiting: until the next try; mismatch: the station has another protocol; expired: the
/// station refuses this page's link (further tries follow, but are not shown).
export type Phase = "connecting" | "open" | "waiting" | "mismatch" | "expired" | "replaced";

/// The part of a WebSocket that is used here.
export interface Socket {
  binaryType: string;
  onopen: (() => void) | null;
  onmessage: ((event: { readonly data: unknown }) => void) | null;
  onclose: (() => void) | null;
  send(data: Uint8Array): void;
  close(): void;
}

export interface Memory {
  get(): string;
  set(secret: string): void;
}

export interface Answer {
  readonly ok: boolean;
  readonly error: string; // the reason of a refusal; empty: the connection was lost before an answer
}

export interface ConnectionParts {
  readonly openSocket: () => Socket;
  readonly secret: Memory;
  readonly name: () => string;
  readonly patientScreen?: boolean; // Hello.patient_screen
  readonly onPhase: (phase: Phase) => void;
  readonly onMessage: (message: ToPage) => void;
  readonly linkExpired?: () => Promise<boolean>; // called after some failed tries; returns whether the station refuses this page's address
  readonly random?: () => number; // [0, 1)
}

export const kFirstWaitMs = 250;
export const kLongestWaitMs = 4000;
/// Waits vary by up to this share, so that many pages do not reconnect at once.
const kJitter = 0.2;
/// A connection that ends sooner after its Welcome counts as a failed try [ms].
export const kSettledMs = 2000;
const kTriesBeforeDoubt = 3;
/// Ticks are acknowledged after the first and after so many.
export const kSeenEvery = 3;
/// A station sends twice a second. A connection that is silent for so long is lost, for any state of the socket.
export const kSilenceMs = 5000;

export type Request = ToHost["what"];

export class Connection {
  private socket: Socket | null = null;
  private state: Phase = "waiting";
  private wait = kFirstWaitMs;
  private retry: ReturnType<typeof setTimeout> | undefined;
  private silence: ReturnType<typeof setTimeout> | undefined;
  private nextRequest = 1;
  private failed = 0; // tries in a row
  private welcomed: ReturnType<typeof setTimeout> | undefined; // until it counts as a good connection
  private ticks = 0n; // since the Welcome
  private readonly waitingFor = new Map<number, (answer: Answer) => void>();

  constructor(private readonly parts: ConnectionParts) {}

  start(): void {
    if (this.socket || this.state === "mismatch" || this.state === "replaced") return;
    clearTimeout(this.retry);
    if (this.state !== "expired") this.enter("connecting");
    let socket: Socket;
    try {
      socket = this.parts.openSocket();
    } catch {
      this.lost();
      return;
    }
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      if (socket !== this.socket) return;
      const hello = create(HelloSchema, {
        protocol: kProtocol,
        secret: this.parts.secret.get(),
        name: this.parts.name(),
        patientScreen: this.parts.patientScreen ?? false,
      });
      this.post({ case: "hello", value: hello }, 0);
    };
    socket.onmessage = (event) => {
      if (socket === this.socket) this.received(event.data);
    };
    socket.onclose = () => {
      if (socket === this.socket) this.lost();
    };
    this.listen();
  }

  /// Sends without asking for an answer. @returns false: there is no connection, nothing was sent
  tell(what: Request): boolean {
    return this.state === "open" && this.post(what, 0);
  }

  /// Sends a request and waits for the host's answer.
  ask(what: Request): Promise<Answer> {
    const request = this.nextRequest++;
    if (this.state !== "open" || !this.post(what, request)) {
      return Promise.resolve({ ok: false, error: "" });
    }
    return new Promise((resolve) => this.waitingFor.set(request, resolve));
  }

  private post(what: Request, request: number): boolean {
    if (!this.socket) return false;
    try {
      this.socket.send(toBinary(ToHostSchema, create(ToHostSchema, { request, what })));
      return true;
    } catch {
      return false;
    }
  }

  private received(data: unknown): void {
    if (!(data instanceof ArrayBuffer)) return;
    this.listen();
    let message: ToPage;
    try {
      message = fromBinary(ToPageSchema, new Uint8Array(data));
    } catch (reason) {
      console.error(reason); // the frame is no ToPage: it is dropped
      return;
    }
    const what = message.what;
    if (what.case === "welcome") {
      if (what.value.protocol !== kProtocol) {
        this.drop();
        this.enter("mismatch");
        return;
      }
      this.parts.secret.set(what.value.secret);
      this.ticks = 0n;
      clearTimeout(this.welcomed);
      this.welcomed = setTimeout(() => {
        this.wait = kFirstWaitMs;
        this.failed = 0;
      }, kSettledMs);
      this.enter("open");
    } else if (what.case === "tick") {
      this.seen();
    } else if (what.case === "notice" && what.value.code === "replaced") {
      this.drop(); // two pages with one secret would take it from each other for ever
      this.enter("replaced");
      return;
    } else if (what.case === "reply") {
      const resolve = this.waitingFor.get(what.value.request);
      this.waitingFor.delete(what.value.request);
      resolve?.({ ok: what.value.ok, error: what.value.error });
    }
    this.parts.onMessage(message);
  }

  /// Newer ticks wait until the station has the acknowledgement of these.
  private seen(): void {
    ++this.ticks;
    if (this.ticks === 1n || this.ticks % BigInt(kSeenEvery) === 0n) {
      this.tell({ case: "seen", value: create(SeenSchema, { ticks: this.ticks }) });
    }
  }

  private listen(): void {
    clearTimeout(this.silence);
    this.silence = setTimeout(() => this.lost(), kSilenceMs);
  }

  private drop(): void {
    clearTimeout(this.silence);
    clearTimeout(this.welcomed);
    const socket = this.socket;
    this.socket = null;
    if (socket) {
      socket.onopen = socket.onmessage = socket.onclose = null;
      try {
        socket.close();
      } catch {
        // it is gone already
      }
    }
    for (const resolve of this.waitingFor.values()) resolve({ ok: false, error: "" });
    this.waitingFor.clear();
  }

  private lost(): void {
    this.drop();
    clearTimeout(this.retry);
    const random = this.parts.random ?? Math.random;
    this.retry = setTimeout(() => this.start(), this.wait * (1 - kJitter + 2 * kJitter * random()));
    this.wait = Math.min(2 * this.wait, kLongestWaitMs);
    if (this.state !== "expired") this.enter("waiting");
    if (++this.failed % kTriesBeforeDoubt === 0) void this.doubt();
  }

  /// A refused link and a station that is gone look alike through a WebSocket.
  private async doubt(): Promise<void> {
    const expired = (await this.parts.linkExpired?.().catch(() => false)) ?? false;
    if (expired && (this.state === "waiting" || this.state === "connecting")) this.enter("expired");
  }

  private enter(phase: Phase): void {
    if (phase === this.state) return;
    this.state = phase;
    this.parts.onPhase(phase);
  }
}
