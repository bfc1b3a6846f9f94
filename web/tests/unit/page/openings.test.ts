// SPDX-License-Identifier: Apache-2.0
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { expect, it } from "vitest";
import { ToPageSchema } from "../../../src/gen/phalanx/cockpit_pb";
import { Opening_Phase, type OpeningSchema, SafetyState } from "../../../src/gen/phalanx/tick_pb";
import { openings } from "../../../src/panels/openings";
import { Store } from "../../../src/state/store";
import { strings } from "../../../src/strings";
import { fakeApp, kMe } from "./fake_app";

const words = strings.openings;
const { CONFIRMED, NOT_FOLLOWED } = Opening_Phase;

function setUp() {
  let now = 0;
  let step = 0n;
  const fake = fakeApp();
  const store = new Store(() => now);
  store.setPhase("open");
  store.receive(create(ToPageSchema, { what: { case: "welcome", value: { page: kMe, mayOperate: true } } }));
  const app = { ...fake.app, store };
  const { element, update } = openings(app);
  const line = () => element.querySelector("[role=status]")!.textContent;
  return {
    fake,
    app,
    state: (operatorPage: number, rendersTorque = true) => store.receive(create(ToPageSchema, { what: { case: "state", value: { operatorPage, rendersTorque } } })),
    tick: (opening: MessageInitShape<typeof OpeningSchema>[], state = SafetyState.SAFETY_RUNNING) => {
      now += 20;
      store.receive(create(ToPageSchema, { what: { case: "tick", value: { tick: ++step, time: now / 1000, opening, state } } }));
      update();
      return line();
    },
    grow: (ms: number) => {
      now += ms;
      update();
      return line();
    },
    buttons: () => [...element.querySelectorAll<HTMLButtonElement>("button:not([hidden])")].filter((button) => !button.closest("[hidden]")),
    refused: () => element.querySelector<HTMLElement>(".refused")!,
    dialog: () => app.dialogs.querySelector<HTMLElement>(".dialog"),
  };
}

it("which digits began inside the object is said while it lasts, and not of a tick that is old", () => {
  const page = setUp();
  expect(page.tick([])).toBe("");
  expect(page.tick([{ digit: 3 }])).toBe("The ring finger began inside the object and has no force. Open the hand, or move the object away.");
  expect(page.tick([{ digit: 0 }, { digit: 1 }, { digit: 4 }])).toBe("The thumb, index finger and little finger began inside the object and have no force. Open the hand, or move the object away.");
  expect(page.tick([{ digit: 1, phase: CONFIRMED }, { digit: 2, phase: NOT_FOLLOWED }])).toBe("The index finger is pushed out of the object. The middle finger did not follow for 3 s and has no force. Open the hand, or move the object away.");
  expect(page.tick([])).toBe("");
  page.tick([{ digit: 3 }]);
  expect(page.grow(10_000)).toBe("");
});

it("a digit that no hand has is not named", () => expect(setUp().tick([{ digit: 17 }])).toBe(""));

it("the operator alone may open a digit, while forces are on and there are motors", () => {
  const page = setUp();
  const offered = () => page.buttons().length;
  const inside = [{ digit: 1, way: 0.0142 }, { digit: 2, phase: CONFIRMED }, { digit: 4, phase: NOT_FOLLOWED }];
  page.tick(inside);
  expect(offered()).toBe(0);
  page.state(kMe + 1);
  page.tick(inside);
  expect(offered()).toBe(0);
  page.state(kMe, false);
  page.tick(inside);
  expect(offered()).toBe(0);
  page.state(kMe);
  page.tick(inside, SafetyState.SAFETY_STOPPED);
  expect(offered()).toBe(0);
  page.tick(inside);
  expect(offered()).toBe(1);
  page.tick([{ digit: 2, phase: CONFIRMED }]);
  expect(offered()).toBe(0);
});

it("nothing is asked of the station before the person has read which digit and how far, and has confirmed", async () => {
  const page = setUp();
  page.state(kMe);
  page.tick([{ digit: 1, way: 0.0142, running: 7n }, { digit: 2, phase: CONFIRMED }, { digit: 4, phase: NOT_FOLLOWED, way: 0.002, running: 7n }]);
  document.body.append(page.app.dialogs);
  page.buttons()[0]!.click();
  expect(page.fake.opened).toEqual([]);
  const choices = [...page.dialog()!.querySelectorAll<HTMLButtonElement>(".opening-choices button")];
  expect(choices.map((choice) => choice.textContent)).toEqual([words.choice("index finger", "14"), words.choice("little finger", "2")]);
  expect(document.activeElement?.textContent).toBe(strings.role.cancel); // a second Enter confirms nothing
  page.tick([{ digit: 1, way: 0.03, running: 8n }]);
  page.fake.refuse = "index: forces have been off since you looked; look, then confirm again";
  choices[0]!.click();
  expect(page.fake.opened.length).toBe(1);
  expect(page.fake.opened[0]).toMatchObject({ digit: 1, running: 7n });
  expect(page.fake.opened[0]!.way).toBeCloseTo(0.0142, 6); // as it was read
  expect(page.dialog()).toBe(null);
  await Promise.resolve();
  await Promise.resolve();
  expect(page.refused().textContent).toBe(page.fake.refuse);
  page.tick([]);
  expect(page.refused().hidden).toBe(true);
});
