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
