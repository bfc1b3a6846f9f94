// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { afterEach, describe, expect, it, vi } from "vitest";
import { ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { pastHand } from "../../../src/panels/past_hand";
import type { LookBack, PastHand } from "../../../src/replay/look_back";
import { strings } from "../../../src/strings";
import { kProtocol } from "../../../src/wire/connection";
import { fakeApp, kMe } from "./fake_app";

const words = strings.past;
const recording = { file: "/home/a/recordings/2026-11-28T10-00-00Z.mcap", bytes: 5000n };
const handAt = (time: number): PastHand => ({ tick: create(TickSchema, { time }), geometry: undefined });
const turn = () => new Promise((resolve) => setTimeout(resolve));

function page(known: Parameters<ReturnType<typeof fakeApp>["state"]>[0] = { operatorPage: kMe, recording }) {
  const fake = fakeApp();
  fake.state(known);
  const seen = { opened: [] as string[], asked: [] as number[], shown: [] as (number | undefined)[], closed: 0 };
  let answer: (time: number) => Promise<PastHand | undefined> = (time) => Promise.resolve(handAt(time));
  const look = {
    at: (time: number) => {
      seen.asked.push(time);
      return answer(time);
    },
    close: () => void ++seen.closed,
  } as unknown as LookBack;
  const note = pastHand(fake.app, (name) => {
    seen.opened.push(name);
    return Promise.resolve(look);
  });
  note.attach({ showPast: (hand) => void seen.shown.push(hand?.tick.time) });
  return { fake, note, seen, text: () => note.element.querySelector("p")!.textContent, answers: (next: typeof answer) => (answer = next) };
}

afterEach(() => vi.restoreAllMocks());

describe("the hand of an earlier moment", () => {
  it("is offered while the plots are paused, read from the running recording, and ends when they go on", async () => {
    const { fake, note, seen, text } = page();
    expect(note.element.hidden).toBe(true);
    note.point(100);
    await turn();
    expect(seen.opened).toEqual([]); // not paused
    fake.store.setPaused(true);
    expect(note.element.hidden).toBe(false);
    expect(text()).toBe(words.hint);
    fake.store.history.push(104.5, []);
    note.point(100);
    await turn();
    expect(seen.opened).toEqual(["2026-11-28T10-00-00Z.mcap"]);
    expect(seen.shown).toEqual([100]);
    expect(text()).toBe(words.shown("4.5"));
    note.point(null); // the pointer leaves the plot: the hand stays, so that it can be looked at from all sides
    note.point(101);
    await turn();
    expect(seen.opened).toHaveLength(1);
    expect(seen.shown).toEqual([100, 101]);
    note.element.querySelector("button")!.click();
    expect(fake.store.paused).toBe(false);
    expect(note.element.hidden).toBe(true);
    await turn();
    expect(seen.shown).toEqual([100, 101, undefined]);
    expect(seen.closed).toBe(1);
  });

  it("is that of the newest moment that was pointed at: those in between are passed over", async () => {
    const { fake, note, seen, answers } = page();
    let arrive = () => {};
    answers((time) => new Promise((resolve) => (arrive = () => resolve(handAt(time)))));
    fake.store.setPaused(true);
    for (const time of [1, 2, 3, 4]) note.point(time);
    await turn();
    for (const time of [5, 6]) note.point(time);
    arrive();
    await turn();
    arrive();
    await turn();
    expect(seen.asked).toEqual([1, 6]);
    expect(seen.shown).toEqual([1, 6]);
  });

  it("is not shown any more if it arrives after the plots go on", async () => {
    const { fake, note, seen, answers } = page();
    let arrive = () => {};
    answers((time) => new Promise((resolve) => (arrive = () => resolve(handAt(time)))));
    fake.store.setPaused(true);
    note.point(1);
    await turn();
    fake.store.setPaused(false);
    arrive();
    await turn();
    expect(seen.shown).toEqual([undefined]);
    fake.store.setPaused(true);
    note.point(2);
    await turn();
    fake.store.setPaused(false); // what is asked for now never comes: its reader is closed
    fake.store.setPaused(true);
    note.point(3);
    await turn();
    arrive();
    await turn();
    expect(seen.shown).toEqual([undefined, undefined, 3]);
  });

  it("of which no step is recorded is not made up: the hand of now returns, and why", async () => {
    const { fake, note, seen, text, answers } = page();
    fake.store.setPaused(true);
    answers(() => Promise.resolve(undefined));
    note.point(1);
    await turn();
    expect(seen.shown).toEqual([undefined]);
    expect(text()).toBe(words.hole);
    vi.spyOn(console, "error").mockImplementation(() => {});
    answers(() => Promise.reject(new Error("busy")));
    note.point(2);
    await turn();
    expect(text()).toBe(words.failed);
    answers((time) => Promise.resolve(handAt(time)));
    note.point(3);
    await turn();
    expect(seen.shown).toEqual([undefined, undefined, 3]);
    expect(seen.opened).toHaveLength(2); // begins again after a failure
  });

  it("cannot be read without a recording, by those who may only watch, and without a connection", async () => {
    const off = page({ operatorPage: kMe });
    off.fake.store.setPaused(true);
    expect(off.text()).toBe(words.notRecorded);
    off.note.point(1);
    await turn();
    expect(off.seen.opened).toEqual([]);
    const watcher = page();
    watcher.fake.store.receive(create(ToPageSchema, { what: { case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: false }) } }));
    watcher.fake.store.setPaused(true);
    expect(watcher.text()).toBe(words.refused);
    const alone = page();
    alone.fake.store.setPaused(true);
    alone.fake.store.setPhase("waiting");
    expect(alone.text()).toBe(words.offline);
  });
});
