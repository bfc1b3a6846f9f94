// SPDX-License-Identifier: Apache-2.0
import { expect, it } from "vitest";
import { peoplePanel } from "../../../src/panels/people_panel";
import { fakeApp } from "./fake_app";

it("no field opens a list of the browser's own, which would take Esc for itself", () => {
  const fields = [...peoplePanel(fakeApp().app).querySelectorAll("input")];
  expect(fields.map((field) => field.autocomplete)).toEqual(["off"]);
});
