// SPDX-License-Identifier: Apache-2.0
import { create, fromBinary, toBinary, type MessageInitShape } from "@bufbuild/protobuf";
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { ExerciseSchema, Exercise_Phase, Exercise_Stage, Exercise_Target_Kind, Feel_Kind, StateSchema, ToHostSchema, ToPageSchema, WelcomeSchema, type ToHost } from "../../../src/gen/phalanx/cockpit_pb";
import { Station } from "../../../src/patient/connection";
import { kProtocol, type Socket } from "../../../src/wire/connection";

class FakeSocket implements Socket {
  binaryType = "";
  onopen: (() => void) | null = null;
  onmessage: ((event: { readonly data: unknown }) => void) | null = null;
  onclose: (() => void) | null = null;
  readonly sent: ToHost[] = [];
  send(data: Uint8Array): void {
    this.sent.push(fromBinary(ToHostSchema, data));
  }
  close(): void {}
  say(what: NonNullable<MessageInitShape<typeof ToPageSchema>["what"]>): void {
    const bytes = toBinary(ToPageSchema, create(ToPageSchema, { what }));
    this.onmessage?.({ data: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength) });
  }
  welcome(): void {
    this.onopen?.();
    this.say({ case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, secret: "abc" }) });
  }
  answer(ok: boolean, error = ""): void {
    const { request } = this.sent.at(-1)!;
    this.say({ case: "reply", value: { $typeName: "phalanx.wire.Reply", request, ok, error } });
  }
}

let socket: FakeSocket;
const postStop = vi.fn(() => Promise.resolve(true));
const stopping = vi.fn();
function station(): Station {
  let kept = "";
  const made = new Station({
    openSocket: () => (socket = new FakeSocket()), secret: { get: () => kept, set: (value) => void (kept = value) }, postStop, changed: () => {}, stopping,
  });
  made.start();
  return made;
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => {
  vi.useRealTimers();
  postStop.mockClear();
  stopping.mockClear();
});

it("says in its hello that it is a patient's screen, and never anything but stop and what is felt", async () => {
  const made = station();
  socket.welcome();
  expect(socket.sent[0]?.what).toMatchObject({ case: "hello", value: { patientScreen: true } });
  void made.rate("pain", 4);
  expect(socket.sent.at(-1)?.what).toMatchObject({ case: "feel", value: { kind: Feel_Kind.PAIN, value: 4 } });
  void made.rate("tired", 9);
  expect(socket.sent.at(-1)?.what).toMatchObject({ case: "feel", value: { kind: Feel_Kind.TIRED, value: 9 } });
  made.stop();
  expect(socket.sent.at(-1)?.what.case).toBe("stop");
  socket.answer(true);
  await vi.advanceTimersByTimeAsync(0);
  expect(stopping).toHaveBeenCalled();
  expect(new Set(socket.sent.map((message) => message.what.case))).toEqual(new Set(["hello", "feel", "stop"]));
});

it("a break that the station takes is no stop", async () => {
  const made = station();
  socket.welcome();
  const answer = made.pause();
  expect(socket.sent.at(-1)?.what).toMatchObject({ case: "feel", value: { kind: Feel_Kind.PAUSE } });
  socket.answer(true);
  expect((await answer).ok).toBe(true);
  await vi.advanceTimersByTimeAsync(2000);
  expect(socket.sent.some((message) => message.what.case === "stop")).toBe(false);
});

it("a break that is refused, late or without a connection becomes a stop", async () => {
  const made = station();
  socket.welcome();
  const refused = made.pause();
  socket.answer(false, "sign in at this screen first");
  expect(await refused).toEqual({ ok: false, error: "sign in at this screen first" });
  expect(socket.sent.at(-1)?.what.case).toBe("stop");
  socket.answer(true);
  const late = made.pause();
  await vi.advanceTimersByTimeAsync(700);
  expect((await late).ok).toBe(false);
  expect(socket.sent.at(-1)?.what.case).toBe("stop");
  socket.onclose?.();
  const before = postStop.mock.calls.length;
  void made.pause();
  await vi.advanceTimersByTimeAsync(1000);
  expect(postStop.mock.calls.length).toBeGreaterThan(before);
});

it("sends an owed stop at a new connection, whatever the page makes of it, and forgets the exercise of the former one", async () => {
  const made = new Station({
    openSocket: () => (socket = new FakeSocket()), secret: { get: () => "", set: () => {} }, postStop: () => Promise.resolve(false), stopping,
    changed: () => { if (made.known.connected === "open" && made.known.ever && fails) throw new Error("the page fails"); },
  });
  let fails = false;
  made.start();
  socket.welcome();
  socket.say({ case: "exercise", value: create(ExerciseSchema, { number: 3, stage: Exercise_Stage.RUNNING, phase: Exercise_Phase.READY }) });
  expect(made.known.exercise?.phase).toBe("ready");
  socket.onclose?.();
  expect(made.known.exercise?.phase).toBe("ready");
  made.stop();
  await vi.advanceTimersByTimeAsync(500);
  fails = true;
  expect(() => socket.welcome()).toThrow("the page fails");
  expect(socket.sent.map((message) => message.what.case)).toContain("stop");
  expect(made.known.exercise).toBeUndefined();
});

it("makes plain fields from the station's messages", () => {
  const made = station();
  socket.welcome();
  socket.say({
    case: "exercise",
    value: create(ExerciseSchema, {
      number: 3, measure: "smoothness", side: "left", stage: Exercise_Stage.RUNNING, phase: Exercise_Phase.TRIAL, asks: Feel_Kind.PAUSE,
      target: { kind: Exercise_Target_Kind.ANGLE, digit: [1], flexion: [NaN, 0.5, NaN, NaN, NaN], sponge: -1 },
    }),
  });
  expect(made.known.exercise).toMatchObject({
    number: 3, side: "left", stage: "running", phase: "trial", asks: undefined, value: undefined, target: { kind: "angle", digits: [1], flexion: [undefined, 0.5, undefined, undefined, undefined] },
  });
  socket.say({ case: "state", value: create(StateSchema, { heldStopped: true, fault: {} }) });
  expect(made.known).toMatchObject({ stopped: true, fault: true });
  socket.say({ case: "exercise", value: create(ExerciseSchema) });
  expect(made.known.exercise).toBeUndefined();
});
