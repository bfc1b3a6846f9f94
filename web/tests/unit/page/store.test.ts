// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { kStaleMs } from "../../../src/state/freshness";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { SafetyState } from "../../../src/gen/phalanx/tick_pb";
import { Store } from "../../../src/state/store";
import { shapesOf } from "../../../src/view3d/shapes";

const stiffness = "force.stiffness_n_per_mm";
const kSampleStale = 1 << 12; // Status::kSampleStale
let now = 0;
let store: Store;
const receive = (what: NonNullable<MessageInitShape<typeof ToPageSchema>["what"]>) => store.receive(create(ToPageSchema, { what }));
const state = (value: string) => receive({ case: "state", value: { value: [{ key: stiffness, value }] } });
const tick = (time: number, more: object = {}) => receive({ case: "tick", value: { tick: BigInt(Math.round(time * 1000)), time, ...more } });

beforeEach(() => {
  now = 1000;
  store = new Store(() => now);
  store.setPhase("open");
});

describe("what a control shows", () => {
  it("is what the station says", () => {
    state("0.5");
    expect(store.value(stiffness)).toBe("0.5");
  });

  it("is what was asked for until it is answered and said, however late the State comes", () => {
    state("0.5");
    store.asked(stiffness, "3");
    state("0.5");
    expect(store.value(stiffness)).toBe("3");
    store.answered(stiffness, "3", true);
    expect(store.value(stiffness)).toBe("3");
    state("3.0");
    expect(store.value(stiffness)).toBe("3.0");
    state("1");
    expect(store.value(stiffness)).toBe("1");
  });

  it("goes back to the truth when it is refused, or never comes true", () => {
    state("0.5");
    store.asked(stiffness, "900");
    store.answered(stiffness, "900", false);
    expect(store.value(stiffness)).toBe("0.5");
    store.asked(stiffness, "3");
    store.answered(stiffness, "3", true);
    now += 10_000;
    expect(store.value(stiffness)).toBe("0.5");
  });

  it("an answer to an earlier wish leaves the newest one alone", () => {
    state("0.5");
    store.asked(stiffness, "1");
    store.asked(stiffness, "2");
    store.answered(stiffness, "1", false);
    expect(store.value(stiffness)).toBe("2");
  });
});

describe("lost", () => {
  it("is said as soon as nothing new comes, also where the same step comes again and again", () => {
    tick(1);
    expect(store.lost).toBe(false);
    now += kStaleMs;
    tick(1);
    expect(store.lost).toBe(false);
    now += 1;
    expect(store.lost).toBe(true);
    tick(1.005);
    expect(store.lost).toBe(false);
  });

  it("is said at once when a step is not from a fresh measurement, though steps go on, and until one is", () => {
    tick(1);
    tick(1.005, { status: kSampleStale });
    expect(store.lost).toBe(true);
    expect(store.viewDead).toBe(true);
    expect(store.unmeasured).toBe(true);
    for (let i = 0; i < 100; ++i) {
      now += 20;
      tick(1.01 + i * 0.02, { status: kSampleStale | 1 });
      expect(store.unmeasured).toBe(true);
    }
    expect(store.freshness.age(now)).toBe(2000);
    expect(store.tick?.time, "the torque's way to zero is plotted").toBeGreaterThan(2.9);
    now += kStaleMs + 1;
    expect(store.lost).toBe(true);
    expect(store.unmeasured, "the station is silent as well").toBe(false);
    tick(4);
    expect(store.lost).toBe(false);
    expect(store.unmeasured).toBe(false);
  });

  it("is said when the station's clock goes on and its step does not, as after a reset without a device", () => {
    tick(1);
    for (let i = 1; i <= 40; ++i) {
      now += 20;
      receive({ case: "tick", value: { tick: 1000n, time: 1 + 0.02 * i } });
    }
    expect(store.lost).toBe(true);
    expect(store.unmeasured).toBe(true);
    expect(store.tick?.time).toBe(1);
  });

  it("of a station that still waits for its first measurement is the device's, of one that rests it is not", () => {
    now += kStaleMs + 1;
    receive({ case: "state", value: { safety: SafetyState.SAFETY_WAITING } });
    expect(store.unmeasured).toBe(true);
    receive({ case: "state", value: { safety: SafetyState.SAFETY_WAITING, stationGone: true } });
    expect(store.unmeasured).toBe(false);
    receive({ case: "state", value: { safety: SafetyState.SAFETY_WAITING, busy: "another scene" } });
    expect(store.unmeasured).toBe(false);
    store.setPhase("waiting");
    expect(store.unmeasured).toBe(false);
  });

  it("is said at once when the connection breaks", () => {
    tick(1);
    store.setPhase("waiting");
    expect(store.lost).toBe(true);
  });

  it("is over with the first step after a page has slept, and not before", () => {
    tick(1);
    now += 60_000;
    expect(store.lost).toBe(true);
    expect(store.freshness.age(now)).toBe(60_000);
    tick(2);
    expect(store.lost).toBe(false);
  });
});

describe("what is drawn", () => {
  it("is not what is felt until the shape of the State's revision has come", () => {
    tick(1);
    expect(store.shapeMissing).toBe(false);
    receive({ case: "state", value: { geometry: 3 } });
    expect(store.viewDead).toBe(true);
    expect(store.lost).toBe(false);
    store.setGeometry(shapesOf(create(GeometrySchema)), 2);
    expect(store.shapeMissing).toBe(true);
    store.setGeometry(shapesOf(create(GeometrySchema)), 3);
    expect(store.viewDead).toBe(false);
    receive({ case: "state", value: { geometry: 4, stationGone: true } });
    expect(store.shapeMissing).toBe(false);
  });

  it("may be another station's after the line broke, whatever its number", () => {
    store.setGeometry(shapesOf(create(GeometrySchema)), 3);
    receive({ case: "state", value: { geometry: 3 } });
    expect(store.shapeMissing).toBe(false);
    store.setPhase("waiting");
    store.setPhase("open");
    expect(store.known).toBeUndefined();
    receive({ case: "state", value: { geometry: 3 } });
    expect(store.known?.geometry).toBe(3);
    expect(store.shapeMissing).toBe(true);
  });
});

describe("the role", () => {
  it("is not known from the line's break until the station has stated who operates", () => {
    const mine = () => {
      receive({ case: "welcome", value: { page: 2, mayOperate: true } });
      receive({ case: "state", value: { operatorPage: 2 } });
    };
    mine();
    expect(store.role).toBe("mine");
    store.setPhase("waiting");
    store.setPhase("open");
    expect(store.role).toBe("offline");
    mine();
    expect(store.role).toBe("mine");
  });
});

describe("listeners", () => {
  it("hear all, though one of them throws", () => {
    const report = vi.spyOn(console, "error").mockImplementation(() => {});
    const heard = vi.fn();
    store.on(["state"], () => {
      throw new Error("broken panel");
    });
    store.on(["state"], heard);
    state("1");
    expect(heard).toHaveBeenCalledOnce();
    expect(report).toHaveBeenCalledOnce();
    report.mockRestore();
  });
});

describe("pictures that are missing", () => {
  const missing = () => store.delivery.figures(now / 1000).missing;
  it("are those that a station at work sent, not those of the time in which it changed", () => {
    for (const [busy, expected] of [["another scene", 0], ["", 59]] as const) {
      store = new Store(() => now);
      store.setPhase("open");
      tick(1);
      receive({ case: "state", value: { busy } });
      tick(2);
      expect(missing(), busy).toBe(expected);
    }
  });
});

describe("ticks", () => {
  it("are not kept while the plots pause, but still shown", () => {
    tick(1);
    store.setPaused(true);
    tick(2);
    expect(store.history.length).toBe(1);
    expect(store.tick?.time).toBe(2);
  });

  it("the history holds ten seconds at 60 Hz", () => {
    for (let i = 0; i < 2000; ++i) tick(i / 60);
    const time = store.history.time();
    expect(time.at(-1)! - time[0]!).toBeGreaterThan(10);
  });
});
