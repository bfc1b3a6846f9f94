// SPDX-License-Identifier: Apache-2.0
// Stop, with a device on a wire: its motors come to zero torque, counted in the ticks of its controller.
import { join } from "node:path";
import { expect, it } from "vitest";
import type { Tick } from "../../src/gen/phalanx/tick_pb";
import { SafetyState } from "../../src/gen/phalanx/tick_pb";
import { strings } from "../../src/strings";
import { Log } from "./support/logs";
import { stage, unseen } from "./support/stage";
import { until } from "./support/until";

const kStopRampTicks = 200; // docs/safety.md: 200 ms, at the controller's 1 kHz
const kOldestStepTicks = 20; // docs/safety.md: a step is acted on for 20 ms at most
const kAtWork = 0.02; // [Nm]; a stop of a motor that rests proves nothing

const play = stage();
const largest = (tick: Tick) => Math.max(...tick.torque.map(Math.abs));

it("brings a device on a wire to zero torque within the stop ramp and the age of a step, and keeps it there until Resume", async () => {
  const { device, station } = await play.wired("grasp_teapot", {}, ["--log", "host.csv"]);
  const page = await play.open(station.url, unseen);
  const ways = [() => page.stopButton.click(), () => page.page.keyboard.press("Escape")];
  /// Of the last ten ticks all, so that the controller has had time to follow.
  const untilAtWork = async () => {
    await page.untilRunning();
    await until("torque", () => page.stream.ticks.length >= 10 && page.stream.ticks.slice(-10).every((tick) => largest(tick) > 2 * kAtWork), () => page.brief());
  };
  const stops: { readonly atWork: boolean }[] = [];
  for (const stop of ways) {
    // The patient lets go every five seconds; a stop that comes only then proves nothing, and is given again.
    do {
      await untilAtWork();
      await stop();
      await page.untilStopped();
      const last = page.stream.ticks.filter((tick) => tick.state === SafetyState.SAFETY_RUNNING).at(-1)!;
      stops.push({ atWork: largest(last) > 2 * kAtWork });
      for (const tick of await page.stream.next(10)) expect(largest(tick), `tick ${tick.tick}`).toBe(0);
      await page.button(strings.stop.resume).click();
      await page.untilState("resumed", (state) => !state.heldStopped);
      expect(stops.length, "stops, nearly all of motors at rest").toBeLessThan(8);
    } while (!stops.at(-1)!.atWork);
  }
  await untilAtWork();
  await station.program.end();
  await device.program.end();
  const { code, output, errors } = station.program;
  expect(code, output + errors).toBe(0);
  expect(output).toContain("ended at zero torque");

  const host = Log.read(join(station.folder, "host.csv"));
  const controller = Log.read(device.log);
  expect(host.first(0, (at) => host.text(at, "state") === "fault"), "steps in fault").toBe(host.rows.length);
  const isIn = (state: string) => (at: number) => host.text(at, "state") === state;
  const torqueAt = (at: number) => controller.number(at, "max_abs_torque_nm");
  let [step, row] = [0, 0];
  for (const [i, { atWork }] of stops.entries()) {
    const what = `stop ${i + 1}`;
    step = host.first(step, isIn("stopping"));
    const stopped = host.first(step, isIn("stopped"));
    const again = host.first(stopped, (at) => host.text(at, "state") !== "stopped");
    expect(again, `${what} and its Resume in the host's log`).toBeLessThan(host.rows.length);
    const before = controller.first(row, (at) => controller.number(at, "acted_tick") >= host.number(step, "tick"));
    const peak = Math.max(...Array.from({ length: 50 }, (_, back) => torqueAt(Math.max(0, before - 1 - back))));
    // A motor at rest may be given a torque again while the ramp lasts, if the patient takes hold just then.
    const settled = before + kStopRampTicks + kOldestStepTicks;
    let zero = settled;
    while (zero > before && torqueAt(zero - 1) === 0) --zero;
    expect(torqueAt(settled), `${what}: torque after the ramp`).toBe(0);
    const up = controller.first(settled, (at) => torqueAt(at) !== 0);
    const resumed = controller.first(before, (at) => controller.number(at, "acted_tick") >= host.number(again, "tick"));
    console.log(`${what}: from ${(1000 * peak).toFixed(0)} mNm to zero in ${zero - before} ticks of the controller; zero for ${up - zero} ticks`);
    if (atWork) expect(peak, `${what}: torque before it`).toBeGreaterThan(kAtWork);
    expect(up, `${what}: torque before Resume`).toBeGreaterThanOrEqual(resumed);
    expect(up, `${what}: no torque came back`).toBeLessThan(controller.rows.length);
    [step, row] = [again, zero];
  }
  const end = host.first(step, isIn("stopping"));
  expect(host.first(host.first(end, isIn("stopped")), (at) => host.text(at, "state") !== "stopped"), "the last stop is the end").toBe(host.rows.length);
});
