// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { beforeEach, describe, expect, it } from "vitest";
import { Notice_Level, ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { toasts } from "../../../src/panels/toasts";
import { Store } from "../../../src/state/store";

let store: Store;
let element: HTMLElement;
const notice = (level: Notice_Level, code: string, text: string) =>
  store.receive(create(ToPageSchema, { what: { case: "notice", value: { level, code, text, unixTime: 1 } } }));
const shown = () => [...element.querySelectorAll(".toast p")].map((text) => text.textContent);

beforeEach(() => {
  store = new Store(() => 0);
  element = toasts(store);
});

describe("toasts", () => {
  it("shows what happens, and a warning's own words", () => {
    notice(Notice_Level.CHANGE, "scene", "pinch_ball");
    notice(Notice_Level.WARNING, "log_broken", "the log cannot be written");
    expect(shown(), "the newest first").toEqual(["the log cannot be written", "pinch_ball"]);
  });

  it("shows nothing of a change that this page made itself, nor of one that it was refused", () => {
    store.receive(create(ToPageSchema, { what: { case: "welcome", value: { page: 2 } } }));
    const by = (who: string, level = Notice_Level.CHANGE, code = "set") =>
      store.receive(create(ToPageSchema, { what: { case: "notice", value: { level, who, code, text: `by ${who}`, unixTime: 1 } } }));
    by("page 2 (127.0.0.1), Anna");
    by("page 2");
    by("page 2", Notice_Level.WARNING, "refused");
    expect(shown()).toEqual([]);
    by("page 3", Notice_Level.WARNING, "refused");
    expect(shown()).toEqual(["by page 3"]);
    by("page 21 (127.0.0.1)");
    by("page 2", Notice_Level.WARNING);
    expect(shown()).toEqual(["by page 2", "by page 21", "by page 3"]);
  });

  it("leaves a fault of the station to its card", () => {
    notice(Notice_Level.FAULT, "fault", "no_sample: no sample has come");
    expect(shown()).toEqual([]);
  });
});
