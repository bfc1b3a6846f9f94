// SPDX-License-Identifier: Apache-2.0
// The joints of one step of a calibration: where each is, where it is to go, and how far it has reached.
import { KeyType, type Wizard, type Wizard_Joint as Joint } from "../gen/phalanx/cockpit_pb";
import { fromTyped, number } from "../state/toml";
import { strings } from "../strings";
import { el, newId, setAttribute, setShown, setText } from "./dom";
import { plainWords } from "./plain_words";

const words = strings.calibration;
const kReachedDeg = 3; // closer than this is there
const kBeyond = 15; // that a bar shows beyond the limits [deg]
const kNoLimits = { min: -20, max: 120 } as const; // of a bar without limits [deg]

const degrees = (radians: number) => (radians * 180) / Math.PI;
const shown = (value: number) => value.toLocaleString(strings.figures, { maximumFractionDigits: 0 });

/// The name of a joint for people: "Index: middle joint".
export function jointName(joint: number): string {
  const digit = Math.floor(joint / 4);
  const part = joint % 4;
  return words.joint(strings.digits[digit] ?? "", words.parts[digit === 0 ? "thumb" : "finger"][part] ?? "");
}

const limits = (joint: Joint) => words.span(shown(degrees(joint.limitMin)), shown(degrees(joint.limitMax)));
const digitsOfHost = ["thumb", "index", "middle", "ring", "little"];
const partsOfHost: Readonly<Record<string, number>> = { mcp_flexion: 0, cmc_flexion: 0, mcp_abduction: 1, cmc_abduction: 1, pip_flexion: 2, dip_flexion: 3, ip_flexion: 3 };

/// Of "index_pip_flexion" it is "Index: middle joint". undefined: it is no joint.
function jointOfHost(name: string): string | undefined {
  const found = /^([a-z]+)_(\w+)$/.exec(name);
  const digit = digitsOfHost.indexOf(found?.[1] ?? "");
  const part = digit === 0 && found?.[2] === "mcp_flexion" ? 2 : partsOfHost[found?.[2] ?? ""];
  return digit < 0 || part === undefined ? undefined : jointName(4 * digit + part);
}

/// The name of a step for people: of "index_pip_flexion second" it is "Index: middle joint, second angle". Others stay as they are.
export function poseName(name: string): string {
  const [joint = "", reference = ""] = name.split(" ");
  const [of, which] = [jointOfHost(joint), words.references[reference]];
  return of === undefined || which === undefined ? name : words.poseOf(of, which);
}

const kJointOfHost = /(?:^angle of )?\b((?:thumb|index|middle|ring|little)_(?:cmc|mcp|pip|dip|ip)_(?:flexion|abduction))(?: (first|second|third|largest|smallest))?\b/g;
const kSensorOfDigit = /\b(curl|splay) of (thumb|index|middle|ring|little)\b/g;
const kFit = /^(.*): -?[\d.]+e[-+]\d+ a count, offset -?[\d.]+, from (\d+) poses, at most ([\d.]+) deg off$/;

/// What the station says of a calibration, with names for people, and without the numbers of its file.
export function calibrationWords(text: string): string {
  return plainWords(text)
    .replace(kFit, (_, sensor: string, poses: string, off: string) => words.fitted(sensor, poses, off))
    .replace(kJointOfHost, (_, joint: string, which?: string) => (which ? poseName(`${joint} ${which}`) : (jointOfHost(joint) ?? joint)))
    .replace(kSensorOfDigit, (_, sensor: string, digit: string) => {
      const name = strings.digits[digitsOfHost.indexOf(digit)] ?? "";
      return sensor === "curl" ? words.bending(name) : words.spreading(name);
    });
}

export class JointTable {
  readonly element = el("div", { class: "joint-table" });
  private rows: Row[] = [];
  private key = "";

  /// @param enter  called with an angle that a person typed [deg]
  constructor(private readonly enter: (joint: number, angle: number) => void) {}

  show(wizard: Wizard, live: boolean): void {
    const key = `${wizard.ofRange} ${wizard.pose} ${wizard.joint.map((joint) => `${joint.joint}${joint.mayEnter}`).join()}`;
    if (key !== this.key) {
      this.key = key;
      this.rows = wizard.joint.map((joint) => new Row(joint, wizard.ofRange, this.enter));
      this.element.replaceChildren(...this.rows.map((row) => row.element));
      setShown(this.element, this.rows.length > 0);
    }
    wizard.joint.forEach((joint, i) => this.rows[i]?.show(joint, live));
  }

  /// The first angle that is to be entered.
  focusFirst(): void {
    this.rows.find((row) => row.wantsAngle)?.focus();
  }
}

class Row {
  readonly element: HTMLElement;
  private readonly present = el("output", { class: "joint-present", "aria-live": "off" });
  private readonly note = el("span", { class: "joint-note" });
  private readonly input = el("input", { type: "text", inputmode: "decimal", class: "number", id: newId("angle") });
  private readonly wrong = el("p", { class: "refused", role: "alert", hidden: true });
  private readonly marker = el("span", { class: "joint-marker" });
  private readonly target = el("span", { class: "joint-target" });
  private readonly reached = el("span", { class: "joint-reached" });
  wantsAngle = false;

  constructor(joint: Joint, private readonly ofRange: boolean, enter: (joint: number, angle: number) => void) {
    const name = jointName(joint.joint);
    const send = () => {
      const typed = this.input.value.trim();
      const value = number(fromTyped(typed, KeyType.KEY_NUMBER));
      const wrong = typed !== "" && !Number.isFinite(value);
      this.input.setAttribute("aria-invalid", String(wrong));
      setText(this.wrong, wrong ? words.noAngle(typed) : "");
      setShown(this.wrong, wrong);
      if (typed !== "" && !wrong) enter(joint.joint, value);
    };
    this.input.addEventListener("change", send);
    const entry = joint.mayEnter
      ? el("label", { class: "joint-entry", for: this.input.id }, words.knownAngle, this.input, words.degree)
      : null;
    const bar = el("div", { class: "joint-bar", "aria-hidden": "true" }, this.reached, this.target, this.marker);
    this.element = el("div", { class: "joint-row", role: "group", "aria-label": name }, el("span", { class: "joint-name" }, name), this.present, bar, this.note, entry, this.wrong);
  }

  show(joint: Joint, live: boolean): void {
    const present = live && joint.present !== undefined ? degrees(joint.present) : undefined;
    const target = joint.target === undefined ? undefined : degrees(joint.target);
    this.wantsAngle = joint.mayEnter && target === undefined;
    setText(this.present, present === undefined ? strings.dash : words.angle(shown(present)));
    const min = this.ofRange ? degrees(joint.limitMin) - kBeyond : Math.min(kNoLimits.min, (target ?? 0) - kBeyond);
    const max = this.ofRange ? degrees(joint.limitMax) + kBeyond : Math.max(kNoLimits.max, (target ?? 0) + kBeyond);
    const share = (value: number) => `${(100 * Math.min(1, Math.max(0, (value - min) / (max - min)))).toFixed(1)}%`;
    place(this.marker, present, share);
    place(this.target, this.ofRange ? undefined : target, share);
    const { reachedMin, reachedMax } = joint;
    const has = this.ofRange && reachedMin !== undefined && reachedMax !== undefined;
    setShown(this.reached, has);
    if (has) {
      this.reached.style.left = share(degrees(reachedMin));
      this.reached.style.right = `${(100 - Number.parseFloat(share(degrees(reachedMax)))).toFixed(1)}%`;
    }
    setText(this.note, has ? words.reached(shown(degrees(reachedMin)), shown(degrees(reachedMax)), limits(joint)) : this.noteOf(present, target, joint));
    const away = present === undefined || target === undefined ? NaN : target - present;
    setAttribute(this.element, "data-there", String(Math.abs(away) <= kReachedDeg));
    if (target !== undefined && this.wrong.hidden && document.activeElement !== this.input) this.input.value = target.toFixed(1);
  }

  focus(): void {
    this.input.focus();
  }

  private noteOf(present: number | undefined, target: number | undefined, joint: Joint): string {
    if (this.ofRange) return words.notReached(limits(joint));
    if (target === undefined) return words.enterAngle;
    if (present === undefined) return words.target(shown(target));
    const away = target - present;
    return Math.abs(away) <= kReachedDeg ? words.there(shown(target)) : words.toGo(shown(target), shown(Math.abs(away)), away > 0);
  }
}

function place(mark: HTMLElement, value: number | undefined, share: (value: number) => string): void {
  setShown(mark, value !== undefined);
  if (value !== undefined) mark.style.left = share(value);
}
