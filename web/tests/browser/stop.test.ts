// SPDX-License-Identifier: Apache-2.0
// Stop: by click, by Space, by Esc, from whoever sees the page; and the motors of a device on a wire come to zero torque, counted in
// the ticks of its controller.
import { join } from "node:path";
import { beforeAll, describe, expect, it } from "vitest";
import { SafetyState, type Tick } from "../../src/gen/phalanx/tick_pb";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { Log } from "./support/logs";
import { small, stage, type Station } from "./support/stage";
import { until } from "./support/until";

const kSlow = process.env["PHALANX_COCKPIT_SLOW_MOTION"] ?? "20"; // two processes and a browser on two cores
const kScene = "grasp_teapot";
const kStopRampTicks = 200; // docs/safety.md: 200 ms, at the controller's 1 kHz
const kTries = 5; // of one stop, before the computer is not to blame
const kOldestStepTicks = 20; // docs/safety.md: a step is acted on for 20 ms at most
const kAtWork = 0.02; // [Nm]; a stop of a motor that rests proves nothing

const play = stage();
let station: Station; // with the device in its own process, for which a busy computer makes no faults
let operator: CockpitPage;
let viewer: CockpitPage;

beforeAll(async () => {
  station = await play.station({ scene: kScene });
  operator = await play.open(station.url, small);
  viewer = await play.open(station.url, small);
});

const largest = (tick: Tick) => Math.max(...tick.torque.map(Math.abs));
/// Of the last ten ticks all, so that the controller has had time to follow.
const atWork = (page: CockpitPage) => page.stream.ticks.length >= 10 && page.stream.ticks.slice(-10).every((tick) => largest(tick) > 2 * kAtWork);

/// Stops in some way while the motors push, sees that the page says so, and resumes.
async function stopAndResume(by: () => Promise<void>): Promise<void> {
  await operator.untilRunningAgain();
  await until("torque", () => atWork(operator), () => operator.brief());
  await by();
  await operator.untilStopped();
  await until("the page says stopped", async () => (await operator.stopBox.textContent())?.includes(strings.safety.stopped), () => operator.brief());
  for (const tick of await operator.stream.next(10)) expect(largest(tick), `tick ${tick.tick}`).toBe(0);
  await operator.button(strings.stop.resume).click();
  await operator.untilState("resumed", (state) => !state.heldStopped);
}

/// A fault between the stop and what came after it, or a host that stood still in its ramp for longer than the device acts on a step: the
/// device goes to zero by itself then, and follows the rest of the ramp.
function isBroken(host: Log, step: number, stopped: number, again: number): boolean {
  if (host.first(step, (at) => host.text(at, "state") === "fault") < again) return true;
  return host.first(step + 1, (at) => host.number(at, "time_s") - host.number(at - 1, "time_s") > 1e-3 * kOldestStepTicks) <= stopped;
}

/// @returns whether the stop proves anything: not where the patient let go before, or a busy computer has broken the link meanwhile
async function stopsOnce(page: CockpitPage, by: () => Promise<void>, at: (tick: number) => void): Promise<boolean> {
  await page.untilResumed("full torque", (state) => state.safety === SafetyState.SAFETY_RUNNING && atWork(page));
  const faults = page.stream.faults.size;
  at(Number(page.stream.newest!.tick));
  await by();
  await page.untilStoppedAfterAll();
  const last = page.stream.ticks.filter((tick) => tick.state === SafetyState.SAFETY_RUNNING).at(-1);
  for (const tick of await page.stream.next(10)) expect(largest(tick), `tick ${tick.tick}`).toBe(0);
  return page.stream.faults.size === faults && last !== undefined && largest(last) > 2 * kAtWork;
}

describe("stop", () => {
  it("stops by a click", () => stopAndResume(() => operator.stopButton.click()));

  it("stops by Space, wherever the focus is, and presses nothing", () =>
    stopAndResume(async () => {
      await operator.button(strings.settings.open).focus();
      await operator.page.keyboard.press("Space");
      expect(await operator.page.getByRole("dialog").count(), "Space pressed the button, too").toBe(0);
    }));

  it("stops by Esc, also in a text field", () =>
    stopAndResume(async () => {
      await operator.stiffnessField.focus();
      await operator.page.keyboard.press("Escape");
    }));

  it("takes Space for a letter in a text field", async () => {
    await operator.tab("people");
    const name = operator.fieldLike(strings.people.name);
    await name.fill("Anna");
    await name.press("End");
    await operator.page.keyboard.press("Space");
    await operator.page.keyboard.type("B");
    expect(await name.inputValue()).toBe("Anna B");
    await operator.stream.next(40);
    expect(operator.stream.state!.heldStopped).toBe(false);
    await name.fill("");
    await operator.tab("touch");
  });

  it("lets a viewer stop, but not resume", async () => {
    expect(await viewer.stiffnessField.isDisabled(), "the second page should only watch").toBe(true);
    await stopAndResume(async () => {
      await viewer.stopButton.click();
      await until("the viewer's page says stopped", async () => (await viewer.stopBox.textContent())?.includes(strings.safety.stopped), () => viewer.brief());
      expect(await viewer.button(strings.stop.resume).isDisabled()).toBe(true);
    });
    const told = operator.stream.notices.filter((notice) => notice.code === "stopped");
    expect(told.at(-1)?.who).toContain(`page ${await viewer.number()} `);
  });

  it("brings a device on a wire to zero torque within the stop ramp and the age of a step, and keeps it there until Resume", async () => {
    for (const { page } of [operator, viewer]) await page.context().close();
    await station.program.end();
    const device = await play.device(kScene, [], kSlow);
    const wired = await play.station({ scene: kScene, slow: kSlow, args: ["--device", device.address, "--log", "host.csv"] });
    const page = await play.open(wired.url, small);
    const ways = { click: () => page.stopButton.click(), key: () => page.page.keyboard.press("Escape") };
    const made: { readonly way: string; readonly tick: number }[] = []; // one may still turn out below as broken by the computer, so two of each
    for (const way of ["click", "key", "click", "key"] as const) {
      for (let tries = 0; !(await stopsOnce(page, ways[way], (tick) => made.push({ way, tick }))); ++tries) {
        console.log(`once more: ${page.stream.faults.size} faults so far; ${page.brief()}`);
        expect(tries, "a stop by " + way + " that no fault came upon").toBeLessThan(kTries);
      }
    }
    await page.untilResumed("torque", () => atWork(page));
    await wired.program.end();
    await device.program.end();
    const { code, output, errors } = wired.program;
    expect(code === 0 || (code === 1 && output.includes("in fault")), `exit code ${code}: ${output}${errors}`).toBe(true);
    expect(output).toContain("ended at zero torque");
    const host = Log.read(join(wired.folder, "host.csv"));
    const controller = Log.read(device.log);
    let [step, row, seen] = [0, 0, 0];
    const proven = new Set<string>();
    const isIn = (state: string) => (at: number) => host.text(at, "state") === state;
    const torqueAt = (at: number) => controller.number(at, "max_abs_torque_nm");
    for (;;) {
      step = host.first(step, isIn("stopping"));
      const stopped = host.first(step, isIn("stopped"));
      const again = host.first(stopped, (at) => host.text(at, "state") !== "stopped");
      if (again >= host.rows.length) break; // the last one is the end of the program
      ++seen;
      if (isBroken(host, step, stopped, again)) {
        console.log(`stop ${seen}: the computer stood still meanwhile, or there was a fault`);
        step = again;
        continue;
      }
      const before = controller.first(row, (at) => controller.number(at, "acted_tick") >= host.number(step, "tick"));
      const peak = Math.max(...Array.from({ length: 50 }, (_, i) => torqueAt(Math.max(0, before - 1 - i))));
      const zero = controller.first(before, (at) => torqueAt(at) === 0);
      const up = controller.first(zero, (at) => torqueAt(at) !== 0);
      const resumed = controller.first(zero, (at) => controller.number(at, "acted_tick") >= host.number(again, "tick"));
      console.log(`stop ${seen}: from ${(1000 * peak).toFixed(0)} mNm to zero in ${zero - before} ticks of the controller; zero for ${up - zero} ticks`);
      if (peak > kAtWork) proven.add(made.filter((one) => one.tick <= host.number(step, "tick")).at(-1)!.way);
      expect(zero - before, `stop ${seen}: ticks to zero torque`).toBeLessThanOrEqual(kStopRampTicks + kOldestStepTicks);
      expect(up, `stop ${seen}: torque before Resume`).toBeGreaterThanOrEqual(resumed);
      expect(up, `stop ${seen}: no torque came back`).toBeLessThan(controller.rows.length);
      [step, row] = [again, zero];
    }
    expect([...proven].sort(), "ways to stop motors at work in the log").toEqual(["click", "key"]);
  });
});
