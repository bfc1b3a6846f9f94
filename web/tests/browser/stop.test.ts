// SPDX-License-Identifier: Apache-2.0
// Stop: by click, by Space, by Esc, from whoever sees the page; and the motors of a device on a wire come to zero torque, counted in
// the ticks of its controller.
import { join } from "node:path";
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { Log } from "./support/logs";
import { small, stage, type OwnDevice, type Station } from "./support/stage";
import { until } from "./support/until";

const kSlow = process.env["PHALANX_COCKPIT_SLOW_MOTION"] ?? "20"; // two processes and a browser on two cores
const kScene = "grasp_teapot";
const kStopRampTicks = 200; // docs/safety.md: 200 ms, at the controller's 1 kHz
const kOldestStepTicks = 20; // docs/safety.md: a step is acted on for 20 ms at most
const kAtWork = 0.02; // [Nm]; a stop of a motor that rests proves nothing

const play = stage();
let device: OwnDevice;
let station: Station;
let operator: CockpitPage;
let viewer: CockpitPage;
let stops = 0;

beforeAll(async () => {
  device = await play.device(kScene, [], kSlow);
  station = await play.station({ scene: kScene, slow: kSlow, args: ["--device", device.address, "--log", "host.csv"] });
  operator = await play.open(station.url, small);
  viewer = await play.open(station.url, small);
});

/// The least of the last ten ticks, so that the controller has had time to follow.
const torque = () => Math.min(...operator.stream.ticks.slice(-10).map((tick) => Math.max(...tick.torque.map(Math.abs))));

async function untilAtWork(): Promise<void> {
  await operator.untilRunningAgain();
  await until("torque", () => torque() > 2 * kAtWork, () => operator.brief());
}

/// Stops in some way while the motors push, sees that the page says so, and resumes.
async function stopAndResume(by: () => Promise<void>): Promise<void> {
  await untilAtWork();
  await by();
  ++stops;
  await operator.untilStopped();
  await until("the page says stopped", async () => (await operator.stopBox.textContent())?.includes(strings.safety.stopped));
  for (const tick of await operator.stream.next(10)) expect(Math.max(...tick.torque.map(Math.abs)), `tick ${tick.tick}`).toBe(0);
  await operator.button(strings.stop.resume).click();
  await operator.untilState("resumed", (state) => !state.heldStopped);
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
    await stopAndResume(async () => {
      expect(await viewer.stiffnessField.isDisabled(), "the second page should only watch").toBe(true);
      await viewer.stopButton.click();
      await until("the viewer's page says stopped", async () => (await viewer.stopBox.textContent())?.includes(strings.safety.stopped));
      expect(await viewer.button(strings.stop.resume).isDisabled()).toBe(true);
    });
    const told = operator.stream.notices.filter((notice) => notice.code === "stopped");
    expect(told.at(-1)?.who).toContain(`page ${await viewer.number()} `);
  });

  it("brings the device to zero torque within the stop ramp and the age of a step, and keeps it there until Resume", async () => {
    await untilAtWork(); // after the last resume
    await station.program.end();
    await device.program.end();
    expect(station.program.code, station.program.output + station.program.errors).toBe(0);
    const host = Log.read(join(station.folder, "host.csv"));
    const controller = Log.read(device.log);
    let [step, row, seen] = [0, 0, 0];
    const isIn = (state: string) => (at: number) => host.text(at, "state") === state;
    const largest = (at: number) => controller.number(at, "max_abs_torque_nm");
    for (;;) {
      step = host.first(step, isIn("stopping"));
      const stopped = host.first(step, isIn("stopped"));
      const again = host.first(stopped, (at) => host.text(at, "state") !== "stopped");
      if (again >= host.rows.length) break; // the last one is the end of the program
      ++seen;
      const before = controller.first(row, (at) => controller.number(at, "acted_tick") >= host.number(step, "tick"));
      const peak = Math.max(...Array.from({ length: 50 }, (_, i) => largest(Math.max(0, before - 1 - i))));
      const zero = controller.first(before, (at) => largest(at) === 0);
      const up = controller.first(zero, (at) => largest(at) !== 0);
      const resumed = controller.first(zero, (at) => controller.number(at, "acted_tick") >= host.number(again, "tick"));
      console.log(`stop ${seen}: from ${(1000 * peak).toFixed(0)} mNm to zero in ${zero - before} ticks of the controller; zero for ${up - zero} ticks`);
      expect(peak, `stop ${seen} came while the motors rested`).toBeGreaterThan(kAtWork);
      expect(zero - before, `stop ${seen}: ticks to zero torque`).toBeLessThanOrEqual(kStopRampTicks + kOldestStepTicks);
      expect(up, `stop ${seen}: torque before Resume`).toBeGreaterThanOrEqual(resumed);
      expect(up, `stop ${seen}: no torque came back`).toBeLessThan(controller.rows.length);
      [step, row] = [again, zero];
    }
    expect(seen, "stops in the log and stops made").toBe(stops);
  });
});
