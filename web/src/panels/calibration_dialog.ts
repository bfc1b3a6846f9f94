// SPDX-License-Identifier: Apache-2.0
// The dialog of a calibration, and of the measurement of a patient's range. It stands beside the view, whose hand leads it; Stop stays in its
// place. Every page shows it while one is on; only the page in control can act in it.
import { Calibrate_Step as Step, Wizard_Method as Method, type Wizard } from "../gen/phalanx/cockpit_pb";
import { mayCalibrate } from "../state/roles";
import { strings } from "../strings";
import type { CalibrateRequest } from "../wire/host";
import { refusal, type App } from "./app";
import { button, el, newId, setAttribute, setShown, setSwitch, setText, switchButton } from "./dom";
import { calibrationWords, JointTable, poseName } from "./joint_table";
import { roleStrip } from "./role_strip";
import { guarded } from "./setting_controls";

const words = strings.calibration;
const kStillSeconds = 0.5; // as long as a position of a range is held
const kAllDigits = [0, 1, 2, 3, 4] as const;

export interface CalibrationDialog {
  readonly element: HTMLElement;
  askDevice(): void; // which method, which fingers
  askRange(): void; // of which patient
}

/// asking: the dialog stands beside a station that runs; on: there is no station, and the hand is that of the calibration.
export type CalibrationShown = "" | "asking" | "on";

/// @param onShown  called when the dialog appears, changes or goes
export function calibrationDialog(app: App, onShown: (shown: CalibrationShown) => void): CalibrationDialog {
  type Asking = "" | "device" | "range";
  let asking: Asking = "";
  let before: Element | null = null; // had the focus
  let told: CalibrationShown = "";
  let shownStep = ""; // which of the steps the focus and the list belong to

  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const say = (text: string) => {
    setText(error, text);
    setShown(error, text !== "");
  };
  async function send(request: CalibrateRequest): Promise<boolean> {
    const answer = await app.host.calibrate(request);
    say(calibrationWords(refusal(answer)));
    return answer.ok;
  }
  const press = (step: Step) => () => void send({ step });

  // ---- before it begins: what is to be calibrated
  const method = (value: Method, text: string, meaning: string, chosen: boolean) => {
    const input = el("input", { type: "radio", name: "calibration-method", value, checked: chosen });
    return { input, row: el("label", { class: "calibration-method" }, input, el("span", {}, el("strong", {}, text), el("span", { class: "hint" }, meaning))) };
  };
  const methods = [
    method(Method.GONIOMETER, words.methods.goniometer, words.methods.goniometerMeaning, true),
    method(Method.JIG, words.methods.jig, words.methods.jigMeaning, false),
    method(Method.STOPS, words.methods.stops, words.methods.stopsMeaning, false),
  ];
  const chosen = new Set<number>(kAllDigits);
  const digits = kAllDigits.map((digit) => {
    const control = switchButton(strings.digits[digit] ?? "", (on) => {
      if (on) chosen.add(digit);
      else chosen.delete(digit);
      setSwitch(control, on);
    });
    setSwitch(control, true);
    return control;
  });
  const label = el("input", { type: "text", maxlength: 40, autocomplete: "off", id: newId("patient") });
  const setup = el(
    "div",
    { class: "calibration-setup" },
    el("p", {}, words.deviceIntro),
    el("fieldset", {}, el("legend", {}, words.method), ...methods.map((one) => one.row)),
    el("fieldset", { class: "calibration-digits" }, el("legend", {}, words.fingers), ...digits),
  );
  const rangeSetup = el(
    "div",
    { class: "calibration-setup" },
    el("p", {}, words.rangeIntro),
    el("label", { class: "calibration-label", for: label.id }, words.label),
    label,
    el("p", { class: "hint" }, words.labelHint),
  );
  const begin = button(words.begin, () => void start(), { class: "primary" });
  const cancel = button(words.cancel, () => close());
  const asks = el("div", { class: "calibration-ask" }, setup, rangeSetup, el("div", { class: "buttons" }, begin, cancel));

  async function start(): Promise<void> {
    const way = Number(methods.find((one) => one.input.checked)?.input.value ?? Method.GONIOMETER);
    const digit = kAllDigits.filter((one) => chosen.has(one));
    if (asking === "device" && digit.length === 0) return say(words.noFinger);
    begin.disabled = true;
    const request: CalibrateRequest =
      asking === "range" ? { step: Step.BEGIN_RANGE, patient: label.value.trim() } : { step: Step.BEGIN, method: way, digit };
    if (await send(request)) asking = "";
    begin.disabled = false;
    update();
  }

  // ---- while it is on
  const step = el("p", { class: "calibration-step" });
  const overall = el("progress", { max: 1, "aria-label": words.progress });
  const instruction = el("p", { class: "instruction", role: "status" });
  const joints = new JointTable((joint, degrees) => void enter(joint, degrees));
  const stillText = el("span", {});
  const stillBar = el("progress", { max: kStillSeconds, "aria-hidden": "true" });
  const still = el("div", { class: "stillness", role: "status" }, el("span", { class: "still-lamp", "aria-hidden": "true" }), stillText, stillBar);
  const measuring = el("progress", { max: 1, "aria-label": words.measuring });
  const measuringBox = el("div", { class: "measuring" }, el("span", {}, words.measuring), measuring);
  const trouble = el("p", { class: "refused", role: "alert", hidden: true });
  const problems = el("ul", { class: "findings" });
  const problemBox = el("div", { class: "import", "data-ok": "false" }, el("h3", {}, words.problems), problems);
  const results = el("ul", { class: "findings" });
  const resultBox = el("div", { class: "import", "data-ok": "true" }, el("h3", {}, words.results), results);
  const measure = button(words.measure, press(Step.MEASURE), { class: "primary" });
  const accept = button(words.accept, press(Step.ACCEPT), { class: "primary" });
  const then = el("p", { class: "hint" }, words.thenStopped);
  const write = button(words.write, press(Step.WRITE), { class: "primary" });
  const again = button(words.again, press(Step.MEASURE));
  const skip = button(words.skip, press(Step.SKIP));
  const back = button(words.back, press(Step.BACK));
  const abandon = button(words.abandon, press(Step.ABANDON), { class: "quiet" });
  const list = el("ol", { class: "poses", "aria-label": words.steps });
  const steps = el("details", { class: "calibration-steps" }, el("summary", {}, words.steps), list);
  const course = el(
    "div",
    { class: "calibration-course" },
    step,
    overall,
    instruction,
    joints.element,
    still,
    measuringBox,
    trouble,
    problemBox,
    resultBox,
    steps,
    then,
    el("div", { class: "buttons calibration-actions" }, measure, accept, write, again, back, skip),
  );

  async function enter(joint: number, degrees: number): Promise<void> {
    await send({ step: Step.ENTER, pose: app.store.state?.wizard?.pose ?? 0, joint, angle: (degrees * Math.PI) / 180 });
  }

  const fingers = (wizard: Wizard) => wizard.digit.map((digit) => strings.openings.digits[digit] ?? "");
  const namesOf = (wizard: Wizard) => (wizard.ofRange ? fingers(wizard) : wizard.name.map(poseName));

  function showList(wizard: Wizard, names: readonly string[]): void {
    const wanted = `${names.join("|")} ${wizard.done.join()} ${wizard.pose}`;
    if (list.dataset["shown"] === wanted) return;
    list.dataset["shown"] = wanted;
    const focused = [...list.querySelectorAll("button")].indexOf(document.activeElement as HTMLButtonElement);
    list.replaceChildren(
      ...names.map((name, pose) => {
        const done = wizard.done[pose] ?? false;
        const now = pose === wizard.pose;
        const mark = now ? words.current : done ? words.measured : words.notMeasured;
        const go = button(name, () => void send({ step: Step.GO_TO, pose }), { "aria-label": `${words.goTo(name)} (${mark})` });
        return el("li", { "data-done": String(done), "aria-current": now ? "step" : undefined }, go, el("span", {}, mark));
      }),
    );
    if (focused >= 0) list.querySelectorAll("button")[focused]?.focus();
  }

  function showStillness(wizard: Wizard): void {
    const held = wizard.stillFor >= kStillSeconds;
    setAttribute(still, "data-still", String(held));
    setText(stillText, held ? words.still : words.moving);
    stillBar.value = Math.min(wizard.stillFor, kStillSeconds);
  }

  function instructionOf(wizard: Wizard, end: boolean, names: readonly string[]): string {
    if (end) return wizard.ofRange ? words.rangeEnd(wizard.finished) : words.deviceEnd(wizard.finished);
    if (!wizard.ofRange) return wizard.instruction;
    const finger = names[wizard.pose] ?? "";
    return wizard.measuring ? words.moveFinger(finger) : words.readyFinger(finger);
  }

  function showCourse(wizard: Wizard): void {
    const names = namesOf(wizard);
    const end = wizard.pose >= names.length;
    const live = app.store.connected;
    setText(step, end ? words.end : words.step(wizard.pose + 1, names.length, names[wizard.pose] ?? ""));
    overall.value = names.length === 0 ? 0 : Math.min(1, wizard.pose / names.length);
    setText(instruction, instructionOf(wizard, end, names));
    joints.show(wizard, live);
    setShown(still, live && !end);
    showStillness(wizard);
    setShown(measuringBox, live && wizard.measuring && !wizard.ofRange);
    measuring.value = wizard.measured;
    const why = app.store.state?.trouble ?? "";
    setText(trouble, calibrationWords(why));
    setShown(trouble, why !== "");
    showLines(problems, wizard.problem.map(calibrationWords));
    setShown(problemBox, wizard.problem.length > 0);
    showLines(results, wizard.result.map(calibrationWords));
    setShown(resultBox, wizard.result.length > 0);
    const missing = wizard.joint.some((joint) => joint.mayEnter && joint.target === undefined);
    setText(measure, wizard.ofRange ? words.beginFinger : words.measure);
    setShown(measure, !end && !(wizard.ofRange && wizard.measuring));
    measure.disabled = wizard.measuring || (!wizard.ofRange && missing);
    setShown(accept, wizard.ofRange && wizard.measuring);
    setShown(again, wizard.ofRange && wizard.measuring);
    setShown(skip, !end);
    back.disabled = wizard.pose === 0 || (wizard.measuring && !wizard.ofRange);
    setShown(write, end && wizard.finished);
    setShown(then, end);
    showList(wizard, names);
    const now = `${wizard.ofRange} ${wizard.pose}`;
    if (now !== shownStep && dialog.contains(document.activeElement)) joints.focusFirst();
    shownStep = now;
  }

  // ---- the dialog
  const id = newId("calibration");
  const title = el("h2", { id });
  const zero = el("p", { class: "calibration-zero" }, words.torqueZero);
  const giveUp = guarded(app, abandon);
  const head = el("div", { class: "calibration-head" }, el("div", {}, title, zero), giveUp);
  const who = roleStrip(app); // that of the side panel is hidden while the dialog is shown
  const dialog = el(
    "section",
    { class: "calibration", role: "dialog", "aria-labelledby": id, tabindex: -1, hidden: true },
    head,
    el("div", { class: "calibration-body" }, error, guarded(app, asks, course)),
  );

  function ask(what: Asking): void {
    before = document.activeElement;
    asking = what;
    say("");
    update();
    (what === "range" ? label : methods.find((one) => one.input.checked)?.input)?.focus();
  }
  function close(): void {
    asking = "";
    say("");
    update();
  }

  function update(): void {
    const { state, role } = app.store;
    const wizard = state?.wizard;
    if (wizard) asking = "";
    if (asking !== "" && !mayCalibrate(role, state)) asking = "";
    const shown = wizard !== undefined || asking !== "";
    const ofRange = wizard?.ofRange ?? asking === "range";
    setText(title, ofRange ? words.rangeTitle : words.deviceTitle);
    setShown(zero, wizard !== undefined);
    setShown(asks, asking !== "");
    setShown(setup, asking === "device");
    setShown(rangeSetup, asking === "range");
    setShown(course, wizard !== undefined);
    setShown(giveUp, wizard !== undefined);
    if (wizard) showCourse(wizard);
    const now: CalibrationShown = wizard ? "on" : shown ? "asking" : "";
    if (now !== told) onShown((told = now));
    if (dialog.hidden === !shown) return;
    setShown(dialog, shown);
    if (shown) head.after(who);
    else who.remove();
    if (shown) return dialog.focus();
    say("");
    if (before instanceof HTMLElement && before.isConnected) before.focus();
    before = null;
  }
  app.store.on(["state", "connection"], update);
  update();
  return { element: dialog, askDevice: () => ask("device"), askRange: () => ask("range") };
}

function showLines(list: HTMLElement, lines: readonly string[]): void {
  const wanted = lines.join("\n");
  if (list.dataset["shown"] === wanted) return;
  list.dataset["shown"] = wanted;
  list.replaceChildren(...lines.map((line) => el("li", {}, line)));
}
