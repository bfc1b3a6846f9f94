// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { peoplePanel } from "../../../src/panels/people_panel";
import { kProtocol } from "../../../src/wire/connection";
import { fakeApp } from "./fake_app";

it("no field opens a list of the browser's own, which would take Esc for itself", () => {
  const fields = [...peoplePanel(fakeApp().app).querySelectorAll("input")];
  expect(fields.map((field) => field.autocomplete)).toEqual(["off"]);
});

it("leads those who may operate to the patients, in a tab that has this page's memory, and no others", () => {
  const { app, store } = fakeApp();
  const link = peoplePanel(app).querySelector<HTMLAnchorElement>("a[href='people.html']")!;
  expect(link.closest("p")!.hidden).toBe(false);
  expect([link.target, link.rel]).toEqual(["_blank", "opener"]);
  store.receive(create(ToPageSchema, { what: { case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, page: 3, mayOperate: false }) } }));
  store.setPhase("waiting");
  expect(link.closest("p")!.hidden).toBe(true);
});
