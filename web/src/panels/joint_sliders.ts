// SPDX-License-Identifier: Apache-2.0
// Postures and a slider for each joint, where the user moves the hand.
import { HandSource } from "../gen/phalanx/cockpit_pb";
import { kDigits, kJoints, kJointsPerDigit } from "../state/channels";
import { Throttle } from "../state/throttle";
import { number, unquote } from "../state/toml";
import { strings } from "../strings";
import type { App } from "./app";
import { button, el, newId, setAttribute, setShown, setText } from "./dom";
import { onLetGo } from "./drag";

const words = strings.hand;
const kPerSecond = 30;
const kOwnWordMs = 1000; // the station's value of a joint may be older than the value sent for it
const kDegrees = 180 / Math.PI;
const kFist = 0.8; // share of the way from the open hand to the end of a flexing joint's range
const kSpread = 1; // a digit's abduction: its second joint

/// Flexing joints most of the way to the end of their range, the others as in the open hand.
export function fist(open: readonly number[], max: readonly number[]): number[] {
  return open.map((angle, joint) =>
    joint % kJointsPerDigit === kSpread ? angle : angle + kFist * ((max[joint] ?? angle) - angle),
  );
}

/// The requested angles: the station's, overlaid by the newest ones of this page.
export class WantedAngles {
  private readonly own = new Map<number, { angle: number; until: number }>(); // [ms]; Infinity: held, or not sent yet

  constructor(private readonly now: () => number = () => performance.now()) {}

  want(joint: number, angle: number): void {
    this.own.set(joint, { angle, until: Infinity });
  }

  /// It is sent. Joints whose slider is not held follow the station again after a while.
  sent(held: ReadonlySet<number>): void {
    for (const [joint, word] of this.own) {
      if (word.until === Infinity && !held.has(joint)) word.until = this.now() + kOwnWordMs;
    }
  }

  forget(): void {
    this.own.clear();
  }

  /// The angles that are shown.
  angles(station: readonly number[]): number[] {
    return this.toSend().map((angle, joint) => (Number.isNaN(angle) ? (station[joint] ?? 0) : angle));
  }

  /// The angles of this page; NaN leaves a joint as it is. The station's values are not sent back to it: they
  /// may be older than what this page has sent.
  toSend(): number[] {
    return Array.from({ length: kJoints }, (_, joint) => {
      const word = this.own.get(joint);
      if (word && this.now() < word.until) return word.angle;
      this.own.delete(joint);
      return NaN;
    });
  }
}

interface JointSlider {
  readonly input: HTMLInputElement;
  readonly output: HTMLElement;
}

export function jointSliders(app: App): HTMLElement {
  const wanted = new WantedAngles();
  const held = new Set<number>();
  const sliders: JointSlider[] = [];
  const angles = () => wanted.angles(app.store.state?.slider ?? []);
  const throttle = new Throttle<null>(() => {
    app.host.sliders(wanted.toSend());
    wanted.sent(held);
  }, kPerSecond);

  function place(): void {
    angles().forEach((angle, joint) => {
      const slider = sliders[joint];
      if (!slider) return;
      if (!held.has(joint)) slider.input.value = String(angle);
      const text = `${Math.round(angle * kDegrees)}${words.degrees}`;
      setText(slider.output, text);
      setAttribute(slider.input, "aria-valuetext", text);
    });
  }
  function letGo(joint: number): void {
    if (!held.delete(joint)) return;
    throttle.flush();
    wanted.sent(held);
  }
  function joint(number: number): HTMLElement {
    const id = newId("joint");
    const input = el("input", { type: "range", id, step: 0.005 });
    const output = el("output", { for: id, "aria-live": "off" });
    sliders[number] = { input, output };
    input.addEventListener("input", () => {
      held.add(number);
      wanted.want(number, Number(input.value));
      place();
      throttle.push(null);
    });
    onLetGo(input, () => letGo(number));
    const names = number < kJointsPerDigit ? words.joints.thumb : words.joints.finger;
    return el("div", { class: "joint" }, el("label", { for: id }, names[number % kJointsPerDigit] ?? ""), input, output);
  }
  const digits = Array.from({ length: kDigits }, (_, digit) =>
    el(
      "fieldset",
      { class: "digit", "data-digit": digit },
      el("legend", {}, strings.digits[digit] ?? ""),
      ...Array.from({ length: kJointsPerDigit }, (_unused, i) => joint(digit * kJointsPerDigit + i)),
    ),
  );
  const go = (to: readonly number[]) => {
    held.clear();
    to.forEach((angle, joint) => !Number.isNaN(angle) && wanted.want(joint, angle));
    place();
    throttle.push(null);
    throttle.flush();
  };
  /// Angles at which the planned grasp presses [rad]; none: the scene has no planned grasp. NaN: the joint stays as it is.
  const plannedAngles = () => {
    const planned = unquote(app.store.value("grasp.type")) !== "none";
    return (app.store.geometry?.jointName ?? []).map((name) => (planned ? number(app.store.value(`motion.angle_deg.${name}`)) / kDegrees : NaN));
  };
  const open = button(words.open, () => app.store.geometry && go(app.store.geometry.jointOpen));
  const closed = button(words.fist, () => app.store.geometry && go(fist(app.store.geometry.jointOpen, app.store.geometry.jointMax)));
  const grasp = button(words.grasp, () => go(plannedAngles()));
  const single = el("details", {}, el("summary", {}, words.single), el("div", { class: "sliders" }, ...digits));
  const box = el("div", { class: "postures" }, el("div", { class: "buttons" }, open, closed, grasp), single);

  const ranges = () => {
    const geometry = app.store.geometry;
    if (!geometry) return;
    const now = angles();
    sliders.forEach((slider, number) => {
      setAttribute(slider.input, "min", String(geometry.jointMin[number] ?? 0));
      setAttribute(slider.input, "max", String(geometry.jointMax[number] ?? 0));
      if (!held.has(number)) slider.input.value = String(now[number] ?? 0);
      slider.input.title = geometry.jointName[number] ?? "";
    });
  };
  const update = () => {
    const { state, role } = app.store;
    setShown(grasp, plannedAngles().some(Number.isFinite));
    const on = state?.source === HandSource.HAND_SLIDERS;
    setShown(box, on);
    if (role !== "mine" || !on) {
      throttle.clear(); // it is no longer this page's to say
      wanted.forget();
      held.clear();
    }
    if (on && state.slider.length === kJoints) place();
  };
  app.store.on(["geometry"], () => {
    ranges();
    update();
  });
  app.store.on(["state", "connection"], update);
  update();
  return box;
}
