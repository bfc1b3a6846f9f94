// SPDX-License-Identifier: Apache-2.0
// Stop: by click, by Space, by Esc, from each page that looks.
import { beforeAll, describe, expect, it } from "vitest";
import type { Tick } from "../../src/gen/phalanx/tick_pb";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { stage, unseen } from "./support/stage";
import { until } from "./support/until";

const kAtWork = 0.02; // [Nm]; a stop of a motor that rests proves nothing

const play = stage();
let operator: CockpitPage;
let viewer: CockpitPage;

beforeAll(async () => {
  const station = await play.station("grasp_teapot", { "motion.hold_s": "600" }); // the patient does not let go
  operator = await play.open(station.url, unseen);
  viewer = await play.open(station.url, unseen);
});

const largest = (tick: Tick) => Math.max(...tick.torque.map(Math.abs));
/// Of the last ten ticks all, so that the controller has had time to follow.
const atWork = (page: CockpitPage) => page.stream.ticks.length >= 10 && page.stream.ticks.slice(-10).every((tick) => largest(tick) > 2 * kAtWork);

/// Stops in some way while the motors push, sees that the page says so, and resumes.
async function stopAndResume(by: () => Promise<void>): Promise<void> {
  await operator.untilRunning();
  await until("torque", () => atWork(operator), () => operator.brief());
  await by();
  await operator.untilStopped();
  await until("the page says stopped", async () => (await operator.stopBox.textContent())?.includes(strings.safety.stopped), () => operator.brief());
  for (const tick of await operator.stream.next(10)) expect(largest(tick), `tick ${tick.tick}`).toBe(0);
  await operator.button(strings.stop.resume).click();
  await operator.untilState("resumed", (state) => !state.heldStopped);
}

describe("stop", () => {
  it("stops by a click", () => stopAndResume(() => operator.stopButton.click()));

  it("stops by Space, wherever the focus is, and presses nothing", () =>
    stopAndResume(async () => {
      await operator.button(strings.look.help).focus();
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
});
