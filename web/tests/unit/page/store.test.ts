// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { channels, digitForces } from "../../../src/state/channels";
import { kStaleMs } from "../../../src/state/freshness";
import { GeometrySchema } from "../../../src/gen/phalanx/geometry_pb";
import { reportLines } from "../../../src/panels/upload_box";
import { Store } from "../../../src/state/store";
import { readImportReport, streamUrl } from "../../../src/wire/http";

const stiffness = "force.stiffness_n_per_mm";
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

  it("is said at once when the connection breaks", () => {
    tick(1);
    store.setPhase("waiting");
    expect(store.lost).toBe(true);
  });

  it("gives a page that was hidden its time anew", () => {
    tick(1);
    now += 60_000;
    expect(store.lost).toBe(true);
    store.freshness.visible(now);
    expect(store.lost).toBe(false);
    now += kStaleMs + 1;
    expect(store.lost).toBe(true);
    expect(store.freshness.age(now)).toBe(60_000 + kStaleMs + 1);
  });
});

describe("what is drawn", () => {
  it("is not what is felt until the shape of the State's revision has come", () => {
    tick(1);
    expect(store.shapeMissing).toBe(false);
    receive({ case: "state", value: { geometry: 3 } });
    expect(store.viewDead).toBe(true);
    expect(store.lost).toBe(false);
    store.setGeometry(create(GeometrySchema), 2);
    expect(store.shapeMissing).toBe(true);
    store.setGeometry(create(GeometrySchema), 3);
    expect(store.viewDead).toBe(false);
    receive({ case: "state", value: { geometry: 4, stationGone: true } });
    expect(store.shapeMissing).toBe(false);
  });

  it("may be another station's after the line broke, whatever its number", () => {
    store.setGeometry(create(GeometrySchema), 3);
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

describe("notices", () => {
  const notice = (unixTime: number, text: string, more: object = {}) => receive({ case: "notice", value: { unixTime, text, code: "set", who: "page 2", ...more } });
  const texts = () => store.notices.map((one) => one.text);

  it("of one person who drags one control are one line, the last", () => {
    for (let i = 0; i < 20; ++i) notice(i, `force.stiffness_n_per_mm = ${i}`);
    expect(texts()).toEqual(["force.stiffness_n_per_mm = 19"]);
  });

  it("of others, of other keys, later ones and other things stay", () => {
    notice(1, "a.b = 1");
    notice(1, "a.b = 2", { who: "page 3" });
    notice(1, "a.b = 3, a.c = 4", { who: "page 3" });
    notice(4, "a.b = 5, a.c = 4", { who: "page 3" });
    notice(4, "stopped the torque", { code: "stopped" });
    notice(4, "stopped the torque", { code: "stopped" });
    expect(texts().length).toBe(6);
  });
});

describe("ticks", () => {
  const contact = [
    { segment: 5, touching: true, force: 2, forceRaw: 3 },
    { segment: 4, touching: true, force: 1, forceRaw: 1 },
    { segment: 15, touching: true, force: 9, forceRaw: 9 },
  ];

  it("what is sent is the factor times the force; a digit's force is the sum of its segments'", () => {
    tick(1, { factor: 0.5, contact });
    expect(digitForces(store.tick)).toEqual([0, 1.5, 0, 0, 0]);
    const of = (quantity: string, part: number) => store.history.channel(channels.find((one) => one.quantity === quantity && one.part === part)!.index).at(-1);
    expect(of("force_raw", 5)).toBe(3);
    expect(of("force_sent", 5)).toBe(1);
    expect(of("force_sent", 0)).toBe(0);
    expect(of("torque", 0)).toBeNaN();
  });

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

describe("addresses and answers", () => {
  it("the stream lies beside the page", () => {
    expect(streamUrl("http://127.0.0.1:8480/")).toBe("ws://127.0.0.1:8480/stream");
    expect(streamUrl("https://host/a/b/index.html#x")).toBe("wss://host/a/b/stream");
  });

  it("an import's report is taken apart, and nonsense is a refusal", () => {
    const good = '{"ok":true,"report":["a","b"],"findings":["c"],"file":"/x.stl"}';
    expect(readImportReport(good, 200)).toEqual({ ok: true, error: "", report: ["a", "b"], facts: null, findings: ["c"], file: "/x.stl" });
    expect(readImportReport('{"ok":false,"error":"open","report":"one\\ntwo"}', 400)).toMatchObject({ ok: false, error: "open", report: ["one", "two"] });
    const own = { verdict: "usable: a closed solid", triangles: 2404, vertices: 1204, extent_m: [0.061, 0.04, 0.038], closed: true, volume_m3: 5e-5,
      findings: [{ kind: "duplicate_vertices", found: 12, meaning: "merged" }, { kind: "holes", found: 0, meaning: "none" }] };
    const read = readImportReport(JSON.stringify({ ok: true, report: own, file: "/x.stl" }), 200);
    expect(reportLines(read)).toEqual(["usable: a closed solid", "1,204 vertices, 2,404 triangles", "61.0 × 40.0 × 38.0 mm", "closed, 50.0 cm³"]);
    expect(read.findings).toEqual(["12 duplicate vertices: merged"]);
    expect(readImportReport("Too large", 413)).toMatchObject({ ok: false, error: "Too large" });
    expect(readImportReport("null", 500)).toMatchObject({ ok: false, error: "HTTP 500", findings: [] });
  });
});
