// SPDX-License-Identifier: Apache-2.0
// The calibration by poses, as the station leads through it.
import { Calibrate_Step, type Wizard } from "../gen/phalanx/cockpit_pb";
import { mayCalibrate } from "../state/roles";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import { button, el, section, setShown, setText } from "./dom";
import { guarded } from "./setting_controls";

const words = strings.wizard;

export function wizardSection(app: App): HTMLElement {
  const error = el("p", { class: "refused", role: "alert", hidden: true });
  const step = async (what: Calibrate_Step, pose = 0) => {
    setText(error, refusal(await app.host.calibrate(what, pose)));
    setShown(error, error.textContent !== "");
  };
  const begin = button(words.begin, () => void step(Calibrate_Step.BEGIN));
  const beginHint = el("p", { class: "hint" });
  const start = el("div", {}, beginHint, el("div", { class: "buttons" }, begin));

  const title = el("h3");
  const instruction = el("p", { class: "instruction", "aria-live": "polite" });
  const progress = el("progress", { max: 1, "aria-label": words.measuring });
  const measuring = el("div", { class: "measuring" }, el("span", {}, words.measuring), progress);
  const raw = el("output", { class: "raw", "aria-label": words.raw });
  const rawBox = el("div", {}, el("h3", {}, words.raw), raw);
  const measure = button(words.measure, () => void step(Calibrate_Step.MEASURE), { class: "primary" });
  const skip = button(words.skip, () => void step(Calibrate_Step.SKIP));
  const back = button(words.back, () => void step(Calibrate_Step.BACK));
  const write = button(words.write, () => void step(Calibrate_Step.WRITE), { class: "primary" });
  const abandon = button(words.abandon, () => void step(Calibrate_Step.ABANDON), { class: "quiet" });
  const poses = el("ol", { class: "poses", "aria-label": words.poses });
  const outcome = el("p", { class: "import-verdict", role: "status" });
  const problems = el("ul", { class: "findings" });
  const problemBox = el("div", { class: "import", "data-ok": "false" }, el("h3", {}, words.problems), problems);
  const results = el("pre", { class: "report", tabindex: 0, "aria-label": words.results });
  const resultBox = el("div", {}, el("h3", {}, words.results), results);
  const course = el(
    "div",
    { class: "wizard" },
    title,
    instruction,
    measuring,
    rawBox,
    outcome,
    problemBox,
    resultBox,
    el("div", { class: "buttons" }, measure, back, skip, write, abandon),
    poses,
  );

  function showPoses(wizard: Wizard): void {
    const wanted = `${wizard.name.join("|")} ${wizard.done.join()} ${wizard.pose}`;
    if (poses.dataset["shown"] === wanted) return;
    poses.dataset["shown"] = wanted;
    const focused = [...poses.querySelectorAll("button")].indexOf(document.activeElement as HTMLButtonElement);
    poses.replaceChildren(
      ...wizard.name.map((name, pose) => {
        const done = wizard.done[pose] ?? false;
        const now = pose === wizard.pose;
        const mark = now ? words.current : done ? words.measured : words.notMeasured;
        const go = button(name, () => void step(Calibrate_Step.GO_TO, pose), { "aria-label": `${words.goTo(name)} (${mark})` });
        return el("li", { "data-done": String(done), "aria-current": now ? "step" : undefined }, go, el("span", {}, mark));
      }),
    );
    if (focused >= 0) poses.querySelectorAll("button")[focused]?.focus();
  }

  function showCourse(wizard: Wizard): void {
    const beyond = wizard.pose >= wizard.name.length;
    setText(title, beyond ? words.beyond : words.pose(wizard.pose + 1, wizard.name.length, wizard.name[wizard.pose] ?? ""));
    setText(instruction, beyond ? "" : wizard.instruction);
    setShown(instruction, !beyond);
    const live = app.store.connected;
    setShown(measuring, live && wizard.measuring);
    progress.value = wizard.measured;
    setText(raw, live ? wizard.raw.join("   ") : strings.dash);
    setShown(rawBox, wizard.raw.length > 0 && !beyond);
    setShown(measure, !beyond);
    setShown(skip, !beyond);
    measure.disabled = wizard.measuring;
    back.disabled = wizard.pose === 0 || wizard.measuring;
    const judged = wizard.finished || wizard.problem.length > 0;
    setText(outcome, wizard.finished ? words.finished : words.unfinished);
    setShown(outcome, judged);
    problems.replaceChildren(...wizard.problem.map((line) => el("li", {}, line)));
    setShown(problemBox, wizard.problem.length > 0);
    setText(results, wizard.result.join("\n"));
    setShown(resultBox, wizard.result.length > 0);
    setShown(write, wizard.finished);
    showPoses(wizard);
  }

  const update = () => {
    const { state, role } = app.store;
    const wizard = state?.wizard;
    setShown(start, wizard === undefined);
    setShown(course, wizard !== undefined);
    if (wizard) showCourse(wizard);
    begin.disabled = !mayCalibrate(role, state);
    const onDevice = state !== undefined && !state.deviceSimulated && state.source === 0;
    setText(beginHint, onDevice ? words.beginHint : words.onlyDevice);
  };
  app.store.on(["state", "connection"], update);
  update();
  return section(words.title, guarded(app, start, course), error);
}
