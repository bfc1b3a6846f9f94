// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { TickSchema } from "../../../src/gen/phalanx/tick_pb";
import { verdictText } from "../../../src/panels/readouts";
import { VerdictLight, verdictOf } from "../../../src/state/verdict";

const none = create(TickSchema);
const steady = create(TickSchema, { factor: 1, contact: [{ segment: 5, touching: true, force: 1 }] });
const decays = create(TickSchema, { contact: [{ segment: 5, touching: false, force: 0.2 }] });
const shakes = create(TickSchema, {
  contact: [
    { segment: 5, touching: true, oscillating: true, frequency: 11.2, swing: 1.23 },
    { segment: 8, touching: true, oscillating: true, frequency: 4, swing: 0.6 },
  ],
});
const bitOnly = create(TickSchema, { status: 1 << 13 });

describe("verdict", () => {
  it("tells no contact, a steady one, and the widest swing of those that shake", () => {
    expect(verdictOf(none).kind).toBe("none");
    expect(verdictOf(decays).kind).toBe("none");
    expect(verdictOf(steady).kind).toBe("steady");
    const verdict = verdictOf(shakes);
    expect(verdict.kind).toBe("shakes");
    expect(verdictText(verdict)).toBe("SHAKES, 11 Hz, 1.2 N");
  });

  it("a contact of a hand at rest is not called steady: nothing is sent that could be", () => {
    expect(verdictOf(create(TickSchema, { ...steady, factor: 0 })).kind).toBe("off");
    expect(verdictOf(create(TickSchema, { ...steady, atRest: true })).kind).toBe("off");
  });

  it("believes the status bit alone, without figures that it does not have", () => {
    expect(verdictText(verdictOf(bitOnly))).toBe("SHAKES");
    expect(verdictText(null)).not.toBe(verdictText(verdictOf(none)));
  });

  it("holds shaking for half a second, with its figures, and then lets go", () => {
    const light = new VerdictLight();
    light.feed(shakes, 10);
    expect(light.feed(steady, 10.4)).toMatchObject({ kind: "shakes", swing: expect.closeTo(1.23, 5) as number });
    expect(light.feed(bitOnly, 10.45)).toMatchObject({ kind: "shakes", swing: expect.closeTo(1.23, 5) as number });
    expect(light.feed(steady, 10.9).kind).toBe("shakes");
    expect(light.feed(steady, 10.96).kind).toBe("steady");
    expect(light.feed(none, 11).kind).toBe("none");
  });
});
