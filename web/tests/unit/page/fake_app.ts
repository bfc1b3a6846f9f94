// SPDX-License-Identifier: Apache-2.0
// A page without a station: what it was told, and what it asked for.
import { create, type MessageInitShape } from "@bufbuild/protobuf";
import { KeyType, StateSchema, ToPageSchema, WelcomeSchema } from "../../../src/gen/phalanx/cockpit_pb";
import type { Opening } from "../../../src/gen/phalanx/tick_pb";
import type { App } from "../../../src/panels/app";
import { Store } from "../../../src/state/store";
import { kProtocol } from "../../../src/wire/connection";
import type { CalibrateRequest, Change, Host } from "../../../src/wire/host";

export const stiffness = "force.stiffness_n_per_mm";
export const kMe = 2; // this page's number

export interface FakeApp {
  readonly app: App;
  readonly store: Store;
  readonly asked: (readonly Change[])[];
  readonly dragging: boolean[]; // of each of `asked`
  readonly resets: number[]; // times of the faults that were to be reset
  readonly loaded: string[]; // scenes
  readonly opened: Opening[]; // that were to be opened
  readonly calibrated: CalibrateRequest[]; // steps of a calibration
  refuse: string; // what the station answers; empty: it does it
  state(state: MessageInitShape<typeof StateSchema>): void;
  /// The page that has control, and the values of keys.
  operate(page: number, values?: readonly (readonly [string, string])[]): void;
}

export function fakeApp(): FakeApp {
  const store = new Store();
  store.setPhase("open");
  const key = [
    { path: stiffness, type: KeyType.KEY_NUMBER, range: { min: 0, max: 100 }, defaultValue: "0.5" },
    { path: "stabiliser.method", type: KeyType.KEY_CHOICE, choice: ["none", "smoothing", "rise_only", "low_pass"], defaultValue: '"rise_only"' },
    { path: "grasp.type", type: KeyType.KEY_CHOICE, choice: ["none", "cylinder", "sphere", "tripod", "pinch", "lateral", "hook", "disk"], defaultValue: '"none"' },
    { path: "grasp.seed", type: KeyType.KEY_INTEGER, defaultValue: "1" },
    { path: "hand.side", type: KeyType.KEY_CHOICE, choice: ["right", "left"], defaultValue: '"right"' },
    { path: "contact.mode", type: KeyType.KEY_CHOICE, choice: ["static", "sliding"], defaultValue: '"static"' },
    { path: "mirror", type: KeyType.KEY_FLAG, defaultValue: "false" },
  ];
  store.receive(create(ToPageSchema, { what: { case: "welcome", value: create(WelcomeSchema, { protocol: kProtocol, page: kMe, mayOperate: true, key }) } }));
  const answer = () => Promise.resolve({ ok: made.refuse === "", error: made.refuse });
  const host = {
    set: (changes: readonly Change[], dragging: boolean) => {
      made.asked.push(changes);
      made.dragging.push(dragging);
      return answer();
    },
    reset: (faultTime: number) => {
      made.resets.push(faultTime);
      return answer();
    },
    calibrate: (request: CalibrateRequest) => {
      made.calibrated.push(request);
      return answer();
    },
    loadScene: (name: string) => {
      made.loaded.push(name);
      return answer();
    },
    openDigit: (seen: Opening) => {
      made.opened.push(seen);
      return answer();
    },
  } as unknown as Host;
  const state = (value: MessageInitShape<typeof StateSchema>) => store.receive(create(ToPageSchema, { what: { case: "state", value } }));
  const made: FakeApp = {
    app: { store, host, dialogs: document.createElement("div"), takeControl: () => {}, upload: () => Promise.reject(new Error("none")) },
    store,
    asked: [],
    dragging: [],
    resets: [],
    loaded: [],
    opened: [],
    calibrated: [],
    refuse: "",
    state,
    operate: (page, values = []) => state({ operatorPage: page, value: values.map(([name, value]) => ({ key: name, value })) }),
  };
  return made;
}
