// SPDX-License-Identifier: Apache-2.0
import { create, fromBinary, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { ResetSchema, ToHostSchema, ToPageSchema, type ToHost, type ToPage } from "../../../src/gen/phalanx/cockpit_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { Connection, kLongestWaitMs, kProtocol, kSeenEvery, kSettledMs, kSilenceMs, type ConnectionParts, type Phase, type Socket } from "../../../src/wire/connection";
import { Host } from "../../../src/wire/host";

class FakeSocket implements Socket {
  binaryType = "";
  onopen: (() => void) | null = null;
  onmessage: ((event: { readonly data: unknown }) => void) | null = null;
  onclose: (() => void) | null = null;
  sent: ToHost[] = [];
  closed = false;
  send(data: Uint8Array): void {
    this.sent.push(fromBinary(ToHostSchema, data));
  }
  close(): void {
    this.closed = true;
  }
  say(what: NonNullable<MessageInitShape<typeof ToPageSchema>["what"]>): void {
    const bytes = toBinary(ToPageSchema, create(ToPageSchema, { what }));
    this.onmessage?.({ data: bytes.slice().buffer });
  }
  welcome(secret = "abc", protocol = kProtocol): void {
    this.onopen?.();
    this.say({ case: "welcome", value: { $typeName: "phalanx.wire.Welcome", protocol, secret, version: "", page: 1, mayOperate: true, key: [], scene: [], profile: [], past: [], clock: 0, unixTime: 0, viewerUrl: [] } });
  }
  answer(request: number, ok: boolean, error = ""): void {
    this.say({ case: "reply", value: { $typeName: "phalanx.wire.Reply", request, ok, error } });
  }
}

let sockets: FakeSocket[] = [];
let phases: Phase[] = [];
let messages: ToPage[] = [];
let kept = "";
const newest = () => sockets.at(-1)!;

function connect(more: Partial<ConnectionParts> = {}): Connection {
  const connection = new Connection({
    openSocket: () => {
      sockets.push(new FakeSocket());
      return newest();
    },
    secret: { get: () => kept, set: (secret) => (kept = secret) },
    name: () => "Anna",
    onPhase: (phase) => phases.push(phase),
    onMessage: (message) => messages.push(message),
    random: () => 0.5,
    ...more,
  });
  connection.start();
  return connection;
}

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  phases = [];
  messages = [];
  kept = "";
});
afterEach(() => vi.useRealTimers());

describe("Connection", () => {
  it("says hello first, and is open once it is welcome", () => {
    kept = "earlier";
    connect();
    newest().onopen?.();
    expect(phases.at(-1)).toBe("connecting");
    expect(newest().sent[0]?.what).toMatchObject({ case: "hello", value: { protocol: kProtocol, secret: "earlier", name: "Anna" } });
    newest().welcome("abc");
    expect(phases.at(-1)).toBe("open");
    expect(kept).toBe("abc");
    expect(phases).toEqual(["connecting", "open"]);
  });

  it("comes back by itself, after waits that double from 0.25 s to 4 s, and begins small again", () => {
    connect();
    newest().welcome();
    const waits: number[] = [];
    for (let i = 0; i < 7; ++i) {
      newest().onclose?.();
      const count = sockets.length;
      let waited = 0;
      while (sockets.length === count && waited < 10_000) {
        vi.advanceTimersByTime(10);
        waited += 10;
      }
      waits.push(waited);
    }
    expect(waits).toEqual([250, 500, 1000, 2000, kLongestWaitMs, kLongestWaitMs, kLongestWaitMs]);
    newest().welcome();
    vi.advanceTimersByTime(kSettledMs);
    newest().onclose?.();
    const count = sockets.length;
    vi.advanceTimersByTime(250);
    expect(sockets.length).toBe(count + 1);
  });

  it("a page that is welcomed and shown out at once waits longer and longer", () => {
    connect();
    for (let i = 0; i < 5; ++i) {
      newest().welcome();
      newest().onclose?.();
      vi.advanceTimersByTime(kLongestWaitMs);
    }
    newest().welcome();
    newest().onclose?.();
    const count = sockets.length;
    vi.advanceTimersByTime(kLongestWaitMs - 1);
    expect(sockets.length).toBe(count);
  });

  it("spreads its waits by a fifth to both sides", () => {
    for (const [random, wait] of [[0, 200], [0.999999, 300]] as const) {
      connect({ random: () => random });
      newest().onclose?.();
      const count = sockets.length;
      vi.advanceTimersByTime(wait - 2);
      expect(sockets.length, `${random}`).toBe(count);
      vi.advanceTimersByTime(3);
      expect(sockets.length, `${random}`).toBe(count + 1);
    }
  });

  it("says that its link is refused, once three tries have failed, and still comes back", async () => {
    const linkExpired = vi.fn(() => Promise.resolve(true));
    connect({ linkExpired });
    for (let i = 0; i < 3; ++i) {
      expect(linkExpired).not.toHaveBeenCalled();
      newest().onclose?.();
      if (i < 2) await vi.advanceTimersByTimeAsync(kLongestWaitMs);
    }
    await vi.advanceTimersByTimeAsync(0);
    expect(phases.at(-1)).toBe("expired");
    await vi.advanceTimersByTimeAsync(kLongestWaitMs);
    expect(phases.at(-1)).toBe("expired");
    newest().welcome();
    expect(phases.at(-1)).toBe("open");
  });

  it("says how many ticks it has taken in: after the first, and after every third; anew with each connection", () => {
    connect();
    const tick = () => newest().say({ case: "tick", value: create(TickSchema) });
    const seen = () => newest().sent.flatMap((message) => (message.what.case === "seen" ? [[message.request, Number(message.what.value.ticks)]] : []));
    newest().welcome();
    for (let i = 0; i < 7; ++i) tick();
    expect(seen()).toEqual([[0, 1], [0, kSeenEvery], [0, 2 * kSeenEvery]]);
    newest().onclose?.();
    vi.advanceTimersByTime(250);
    newest().welcome();
    tick();
    expect(seen()).toEqual([[0, 1]]);
  });

  it("drops a frame that is no message, and reports it", () => {
    const report = vi.spyOn(console, "error").mockImplementation(() => {});
    connect();
    newest().welcome();
    const count = messages.length;
    newest().onmessage?.({ data: Uint8Array.of(255, 255, 255).buffer });
    expect([report.mock.calls.length, messages.length]).toEqual([1, count]);
    newest().say({ case: "tick", value: create(TickSchema) });
    expect(messages.length).toBe(count + 1);
    report.mockRestore();
  });

  it("gives up a line that is silent, also before the welcome", () => {
    connect();
    vi.advanceTimersByTime(kSilenceMs);
    expect(phases.at(-1)).toBe("waiting");
    expect(sockets[0]?.closed).toBe(true);
    vi.advanceTimersByTime(250);
    newest().welcome();
    vi.advanceTimersByTime(kSilenceMs - 1);
    expect(phases.at(-1)).toBe("open");
    vi.advanceTimersByTime(1);
    expect(phases.at(-1)).toBe("waiting");
  });

  it("hears nothing more of a socket that it gave up", () => {
    connect();
    const old = newest();
    old.welcome();
    vi.advanceTimersByTime(kSilenceMs + 250);
    const count = messages.length;
    old.welcome("other");
    expect(messages.length).toBe(count);
    expect(kept).toBe("abc");
  });

  it("stops trying where the station speaks another protocol", () => {
    connect();
    newest().welcome("abc", kProtocol + 1);
    expect(phases.at(-1)).toBe("mismatch");
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(1);
    expect(kept).toBe("");
  });

  it("gives each answer to who asked, and tells all who wait when the line breaks", async () => {
    const connection = connect();
    newest().welcome();
    const ask = () => connection.ask({ case: "reset", value: create(ResetSchema) });
    const [first, second, third] = [ask(), ask(), ask()];
    const numbers = newest().sent.slice(-3).map((message) => message.request);
    expect(new Set(numbers).size).toBe(3);
    newest().answer(numbers[1]!, false, "no");
    newest().answer(numbers[0]!, true);
    expect(await first).toMatchObject({ ok: true });
    expect(await second).toEqual({ ok: false, error: "no" });
    newest().onclose?.();
    expect(await third).toEqual({ ok: false, error: "" });
    expect(await ask()).toMatchObject({ ok: false });
  });

  it("drops a frame that is no message, and goes on", () => {
    connect();
    newest().welcome();
    const count = messages.length;
    newest().onmessage?.({ data: new Uint8Array([255, 255, 255]).buffer });
    newest().onmessage?.({ data: "text" });
    expect(messages.length).toBe(count);
    newest().answer(99, true);
    expect(messages.length).toBe(count + 1);
  });
});

describe("stop", () => {
  const run = (connection: Connection, fallback: () => Promise<boolean>) => new Host(connection, fallback).stop();

  it("is confirmed by the socket, and then by nothing else", async () => {
    const connection = connect();
    newest().welcome();
    const fallback = vi.fn(() => Promise.resolve(true));
    const stop = run(connection, fallback);
    const message = newest().sent.at(-1)!;
    expect(message.what.case).toBe("stop");
    newest().answer(message.request, true);
    expect(await stop).toBe(true);
    expect(fallback).not.toHaveBeenCalled();
  });

  it("goes by HTTP where there is no connection", async () => {
    const connection = connect();
    const fallback = vi.fn(() => Promise.resolve(true));
    const stop = run(connection, fallback);
    await vi.advanceTimersByTimeAsync(1000);
    expect(await stop).toBe(true);
    expect(fallback).toHaveBeenCalledOnce();
  });

  it("goes by HTTP as well where the socket does not confirm it", async () => {
    const connection = connect();
    newest().welcome();
    const fallback = vi.fn(() => Promise.resolve(true));
    const stop = run(connection, fallback);
    await vi.advanceTimersByTimeAsync(1000);
    expect(await stop).toBe(true);
    expect(fallback).toHaveBeenCalledOnce();
  });

  it("says that it failed where neither way confirms it", async () => {
    const connection = connect();
    const stop = run(connection, () => Promise.resolve(false));
    await vi.advanceTimersByTimeAsync(1000);
    expect(await stop).toBe(false);
  });
});

describe("resume and reset", () => {
  it("say what the person has seen", () => {
    const host = new Host(connect(), () => Promise.resolve(false));
    newest().welcome();
    void host.resume(7n);
    expect(newest().sent.at(-1)?.what).toMatchObject({ case: "resume", value: { stops: 7n } });
    void host.reset(12.5);
    expect(newest().sent.at(-1)?.what).toMatchObject({ case: "reset", value: { faultTime: 12.5 } });
  });
});
