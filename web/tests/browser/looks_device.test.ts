// SPDX-License-Identifier: Apache-2.0
// With a device on a wire: its faults and its calibration, as seen and as they work.
import { beforeAll, describe, expect, it } from "vitest";
import { calibrationWords, poseName } from "../../src/panels/joint_table";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { shootReadable } from "./support/readable";
import { stage, type OwnDevice } from "./support/stage";
import { until } from "./support/until";

const play = stage();
let device: OwnDevice;
let cockpit: CockpitPage;

beforeAll(async () => {
  const wired = await play.wired("grasp_teapot");
  device = wired.device;
  cockpit = await play.open(wired.station.url);
});

/// The station goes on and sends steps, but of a hand that nobody measures: it is grey, and the page says why. (While the computer stands
/// still the page says that nothing comes at all, so its words are waited for.)
async function untilUnmeasured(): Promise<void> {
  await cockpit.stream.next(3);
  await until("a grey hand", async () => (await cockpit.probe())!.lost, () => cockpit.brief());
  expect(await cockpit.lost()).toBe(true);
  expect((await cockpit.probe())!.arrows).toEqual([]);
  const band = cockpit.page.locator(".lost-band");
  await until("the page says why", () => band.getByText(strings.lost.unmeasured, { exact: true }).isVisible(), () => band.innerText());
}

describe("a device on a wire", () => {
  it("has a panel", async () => {
    await cockpit.untilRunning();
    await cockpit.tab("device");
    await shootReadable(cockpit, "30_device");
    expect(await cockpit.page.getByText(device.address).isVisible()).toBe(true);
  });

  it("is calibrated pose by pose, in a dialog beside the hand, without an alarm", async () => {
    const words = strings.calibration;
    await cockpit.button(words.device).click();
    await cockpit.page.getByText(words.methods.jig, { exact: true }).click();
    await shootReadable(cockpit, "31_calibration_asks");
    await cockpit.button(words.begin).click();
    await cockpit.untilState("the calibration", (state) => state.wizard !== undefined && state.busy === "");
    const { wizard } = cockpit.stream.state!;
    const dialog = cockpit.page.getByRole("dialog", { name: words.deviceTitle });
    await dialog.getByText(words.step(1, wizard!.name.length, poseName(wizard!.name[0]!))).waitFor();
    await dialog.getByText(words.torqueZero).waitFor();
    await until("live counts", () => (cockpit.stream.state!.wizard?.raw.length ?? 0) > 0, () => cockpit.brief());
    await until("a hand that is not grey", async () => !(await cockpit.probe())!.lost, () => cockpit.brief());
    expect(await cockpit.page.locator(".lost-band").isVisible()).toBe(false);
    expect((await cockpit.probe())!.ghost.length).toBeGreaterThan(0);
    expect(await cockpit.page.locator("button.stop").isVisible()).toBe(true);
    await shootReadable(cockpit, "31_wizard");
    await cockpit.button(words.measure).click();
    await until("measuring", () => cockpit.stream.state!.wizard!.measuring || cockpit.stream.state!.wizard!.done[0] === true, () => cockpit.brief());
    await shootReadable(cockpit, "32_wizard_measures");
    await until("the first pose is measured", async () => {
      const { wizard: now, trouble } = cockpit.stream.state!;
      if (now!.done[0] === true) return true;
      if (!now!.measuring && trouble !== "") await cockpit.button(words.measure).click(); // the simulated hand moved: again, while it rests
      return false;
    }, () => cockpit.brief());
    for (const _ of wizard!.name.slice(1)) {
      const pose = cockpit.stream.state!.wizard!.pose;
      await cockpit.button(words.skip).click();
      await until("the next pose", () => (cockpit.stream.state!.wizard?.pose ?? 0) > pose, () => cockpit.brief());
      if ((cockpit.stream.state!.wizard?.pose ?? 0) >= wizard!.name.length) break;
    }
    const { problem, result } = await until("what was refused", () => {
      const { wizard: now } = cockpit.stream.state!;
      return now !== undefined && now.problem.length > 0 && now;
    }, () => cockpit.brief());
    for (const words of [...problem, ...result].map(calibrationWords)) await cockpit.page.getByText(words).first().waitFor();
    await shootReadable(cockpit, "33_wizard_refused");
    await cockpit.button(words.abandon).click();
    await cockpit.untilState("no wizard any more", (state) => state.wizard === undefined && !state.stationGone && state.busy === "");
    await cockpit.untilStopped(); // no motor begins by itself
    await cockpit.button(strings.stop.resume).click();
  });

  it("whose cable is pulled is a fault that says what to do, and one again after a Reset that changes nothing", async () => {
    await cockpit.untilRunning();
    await device.program.kill();
    await cockpit.untilState("the fault", (state) => state.fault !== undefined);
    const fault = cockpit.stream.state!.fault!;
    const card = cockpit.page.getByRole("alert").filter({ has: cockpit.page.getByRole("heading", { name: /Fault/ }) });
    await card.waitFor();
    for (const words of [fault.meaning, fault.remedy]) expect(await card.innerText()).toContain(words);
    await until("the report's place", () => (cockpit.stream.state!.fault?.report ?? "") !== "", () => cockpit.brief());
    await untilUnmeasured();
    await shootReadable(cockpit, "34_fault");
    await card.getByRole("button", { name: strings.fault.reset, exact: true }).click();
    await until("the fault again", () => (cockpit.stream.state!.fault?.time ?? 0) > fault.time, () => cockpit.brief());
    expect(cockpit.stream.state!.fault!.name).toBe(fault.name);
    await untilUnmeasured();
  });
});
