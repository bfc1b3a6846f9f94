// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { SafetyState } from "../../../src/gen/phalanx/tick_pb";
import { lostBand, type LostBand } from "../../../src/panels/lost_band";
import { kStaleMs } from "../../../src/state/freshness";
import { Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";

const kSampleStale = 1 << 12; // Status::kSampleStale
const words = strings.lost;
let now = 0;
let store: Store;
let band: LostBand;
const receive = (what: NonNullable<MessageInitShape<typeof ToPageSchema>["what"]>) => store.receive(create(ToPageSchema, { what }));
const tick = (number: number, status = 0) => receive({ case: "tick", value: { tick: BigInt(number), time: number / 100, status } });
const said = () => {
  band.update(now);
  return band.element.hidden ? "" : band.element.querySelector("[role=alert]")!.textContent;
};

/// So long passes in frames of the page, which hears nothing.
const pass = (ms: number) => {
  for (const end = now + ms; now < end; ) store.freshness.beat((now += Math.min(16, end - now)));
};

beforeEach(() => {
  now = 1000;
  store = new Store(() => now);
  band = lostBand(store);
  store.setPhase("open");
  receive({ case: "state", value: {} });
  store.setPhase("open");
  tick(1);
  store.setGeometry({ left: false, segmentName: [], jointName: [], jointMin: [], jointMax: [], jointOpen: [], skin: null, segments: null, object: null, objectDisplay: null, underside: null }, 0);
});

describe("the band over the view", () => {
  it("is not there while the hand is measured", () => {
    expect(said()).toBe("");
  });

  it("says another sentence for a device that does not measure than for a station that is lost or silent", () => {
    tick(2, kSampleStale);
    expect(said()).toBe(words.unmeasured);
    expect(band.element.textContent).toContain(words.unmeasuredWhy);
    pass(2000);
    tick(3, kSampleStale);
    expect(said()).toBe(words.unmeasured);
    expect(band.element.textContent).toContain(words.measured("2.0"));
    pass(kStaleMs + 1);
    expect(said()).toBe(words.stale);
    store.setPhase("waiting");
    expect(said()).toBe(words.closed);
    store.setPhase("open");
    receive({ case: "state", value: {} });
    store.setGeometry(store.geometry!, 0);
    tick(4);
    expect(said()).toBe("");
  });

  it("does not call a station silent that the page itself did not listen to, as while it brings in its view", () => {
    receive({ case: "state", value: { safety: SafetyState.SAFETY_RUNNING } });
    for (let block = 0; block < 3; ++block) {
      store.freshness.beat((now += 2000));
      expect(store.lost, "the picture is old").toBe(true);
      expect(said()).toBe("");
      tick(2 + block);
    }
    store.freshness.beat((now += 2000));
    pass(kStaleMs);
    expect(said(), "it has listened since").toBe(words.stale);
  });

  it("calls a station silent in the end however slow the page's frames are", () => {
    receive({ case: "state", value: { safety: SafetyState.SAFETY_RUNNING } });
    let frames = 0;
    for (; frames < 20 && said() === ""; ++frames) store.freshness.beat((now += 1000));
    expect(said()).toBe(words.stale);
    expect(frames).toBe(5);
  });

  it("gives a station whose line has just opened as much time as any other", () => {
    store.setPhase("waiting");
    pass(10_000);
    store.setPhase("open");
    receive({ case: "state", value: { safety: SafetyState.SAFETY_RUNNING } });
    store.setGeometry(store.geometry!, 0);
    store.freshness.beat(now);
    expect(said()).toBe("");
    pass(kStaleMs);
    expect(said()).toBe(words.stale);
  });
});
