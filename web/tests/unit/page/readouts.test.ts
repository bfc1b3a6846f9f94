// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { openings } from "../../../src/panels/openings";
import { readouts } from "../../../src/panels/readouts";
import { Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";
import { fakeApp } from "./fake_app";

it("a screen reader is interrupted by shaking alone; contact and its end are said when there is time", () => {
  let now = 0;
  const store = new Store(() => now);
  store.setPhase("open");
  const { element, update } = readouts(store, openings({ ...fakeApp().app, store }));
  let step = 0n;
  const said = (contact: { touching: boolean; oscillating?: boolean }[]) => {
    now += 2000; // a shake is held for a while
    store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: ++step, time: Number(step), factor: 1, contact } } }));
    update();
    const region = (role: string) => element.querySelector(`[role=${role}]:not(.digit-forces)`)?.textContent;
    return { polite: region("status"), assertive: region("alert") };
  };
  const words = strings.verdict;
  expect(element.querySelectorAll("[aria-live=assertive]").length).toBe(0);
  expect(said([])).toEqual({ polite: words.none, assertive: "" });
  expect(said([{ touching: true }])).toEqual({ polite: words.steady, assertive: "" });
  expect(said([{ touching: true, oscillating: true }])).toEqual({ polite: "", assertive: words.shakes });
  expect(said([{ touching: true }])).toEqual({ polite: words.steady, assertive: "" });
});

it("a digit's bar ends at its limit, which is said in words; a force that is not felt is marked in words, and is at no limit", () => {
  const store = new Store(() => 0);
  store.setPhase("open");
  const { element, update } = readouts(store, openings({ ...fakeApp().app, store }));
  const sensed = [0, 1, 2, 3, 4, 5, 6, 7]; // thumb and index finger
  const value = [{ key: "limits.fingertip_force_n", value: "5" }];
  store.receive(create(ToPageSchema, { what: { case: "state", value: { sensedJoint: sensed, rendersTorque: true, value } } }));
  const contact = [2, 5, 8].map((segment, i) => ({ segment, touching: true, force: [2.5, 4.98, 5][i]!, normal: [0, 0, 1] }));
  store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: 1n, time: 1, factor: 1, contact } } }));
  update();
  const cards = [...element.querySelectorAll<HTMLElement>(".digit-force")];
  expect(cards.map((card) => card.querySelector<HTMLElement>(".bar")!.style.transform).slice(0, 3)).toEqual(["scaleX(0.500)", "scaleX(0.996)", "scaleX(1.000)"]);
  const notes = cards.map((card) => [...card.querySelectorAll<HTMLElement>(".digit-note")].filter((note) => !note.hidden).map((note) => note.textContent));
  expect(notes).toEqual([[], [strings.atLimit], [strings.notFelt], [strings.notFelt], [strings.notFelt]]);
  const felt = () => cards.map((card) => card.dataset["felt"]);
  expect(felt()).toEqual(["true", "true", "false", "false", "false"]);
  store.receive(create(ToPageSchema, { what: { case: "state", value: { sensedJoint: sensed, rendersTorque: false, value } } }));
  expect(felt(), "a glove that only stops a finger").toEqual(Array(5).fill("false"));
});
