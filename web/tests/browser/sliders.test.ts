// SPDX-License-Identifier: Apache-2.0
// Without a patient: every slider moves its joint, the object is met and felt, and the patient comes back.
import { beforeAll, describe, expect, it } from "vitest";
import { Opening_Phase } from "../../src/gen/phalanx/tick_pb";
import { openingsText } from "../../src/panels/openings";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { faultsOfLayout, kSizes } from "./support/layout";
import { differing, shoot } from "./support/pictures";
import { small, stage } from "./support/stage";
import { until } from "./support/until";

const kJoints = 20;
const kNear = 0.02; // [rad]; a slider's step is 0.005
const play = stage();
let cockpit: CockpitPage;

beforeAll(async () => {
  // Without a planned grasp, whose wrist would move when the ball changes.
  const values = {
    "grasp.type": '"none"',
    "hand.position_mm": "[0, -86, 74]",
    "hand.rotation_deg": "[90, 0, 0]",
    motion: '{ name = "power_grasp", closure = 0.4, thumb = 0.87, index = 1.18, middle = 1.09, ring = 0.96, little = 1.08 }',
  };
  cockpit = await play.open((await play.station("squeeze_ball", values)).url, small);
  await cockpit.untilRunning();
});

const joints = () => cockpit.page.getByRole("group", { name: /./ }).getByRole("slider");
const angle = (joint: number) => cockpit.stream.newest?.hcpAngle[joint] ?? NaN;

async function untilAt(joint: number, wanted: number): Promise<void> {
  await until(`joint ${joint} at ${wanted.toFixed(2)} rad`, () => Math.abs(angle(joint) - wanted) < kNear, () => `it is at ${angle(joint).toFixed(3)}; ${cockpit.brief()}`);
}

/// Puts a slider on the step that is nearest to an angle, as a person would.
async function moveTo(joint: number, wanted: number): Promise<void> {
  const slider = joints().nth(joint);
  const step = await slider.evaluate((input, value) => {
    const [field, before] = [input as HTMLInputElement, (input as HTMLInputElement).value];
    field.value = String(value);
    const nearest = field.value;
    field.value = before;
    return nearest;
  }, wanted);
  await slider.fill(step);
}

describe("the sliders", () => {
  it("take the hand over from the patient", async () => {
    await cockpit.setPatient(false);
    expect(cockpit.stream.state!.slider.length).toBe(kJoints);
    await until("the switch is off", async () => (await cockpit.switch(strings.hand.patient).getAttribute("aria-checked")) === "false");
    await cockpit.openSingleJoints();
    await until("20 sliders", async () => (await joints().count()) === kJoints, async () => `${await joints().count()} are there`);
  });

  it("move one joint each", async () => {
    await cockpit.button(strings.hand.open).click();
    const { jointMin, jointMax, jointOpen } = await cockpit.geometry();
    for (let joint = 0; joint < kJoints; ++joint) await untilAt(joint, jointOpen[joint]!);
    for (let joint = 0; joint < kJoints; ++joint) {
      const [open, min, max] = [jointOpen[joint]!, jointMin[joint]!, jointMax[joint]!];
      const wanted = open + 0.3 * (max - open > open - min ? max - open : min - open);
      await moveTo(joint, wanted);
      await untilAt(joint, wanted);
      cockpit.stream.newest!.hcpAngle.forEach((now, other) => {
        if (other !== joint) expect(Math.abs(now - jointOpen[other]!), `joint ${other} is not open while ${joint} moves`).toBeLessThan(kNear);
      });
      await moveTo(joint, open);
      await untilAt(joint, open);
    }
    for (let joint = 0; joint < kJoints; ++joint) await untilAt(joint, jointOpen[joint]!);
  });

  it("let one see hand and object: a hand that stands still, and nothing but the object goes", async () => {
    const view = cockpit.page.getByRole("application", { name: strings.view.label });
    const look = async () => {
      const frames = (await cockpit.probe())!.frames;
      await until("another frame", async () => (await cockpit.probe())!.frames > frames + 1);
      return view.screenshot();
    };
    await cockpit.page.getByText(strings.view.partsMenu, { exact: true }).click();
    const [one, two] = [await look(), await look()];
    await cockpit.switch(strings.view.parts.object).click();
    const without = await look();
    await cockpit.switch(strings.view.parts.object).click();
    await cockpit.page.getByText(strings.view.partsMenu, { exact: true }).click();
    const still = await differing(cockpit.page, one, two);
    const object = await differing(cockpit.page, two, without);
    const open = await look();
    await cockpit.button(strings.hand.fist).click();
    await cockpit.stream.next(90);
    const fist = await differing(cockpit.page, open, await look());
    console.log(`pixels that change: ${(100 * still).toFixed(2)} % when nothing moves, ${(100 * object).toFixed(2)} % without the object, ${(100 * fist).toFixed(2)} % with a fist`);
    expect(still).toBeLessThan(0.005);
    expect(object).toBeGreaterThan(0.02);
    expect(fist).toBeGreaterThan(0.02);
  });

  it("give force where the object is met", async () => {
    await cockpit.untilRunning();
    await cockpit.untilTouching();
    const probe = await until("an arrow", async () => {
      const now = (await cockpit.probe())!;
      return now.arrows.length > 0 && now;
    }, () => cockpit.brief());
    expect(probe.arrows[0]!.length).toBeGreaterThan(0);
    await cockpit.button(strings.hand.open).click();
    await until("nothing is touched", () => cockpit.stream.newest!.contact.length === 0, () => cockpit.brief());
  });

  it("close on an object that then changes: the page says which digits have no force, until the hand is opened", async () => {
    const { page, stream } = cockpit;
    const line = page.locator(".silent-digits p");
    expect(await line.textContent()).toBe("");
    await cockpit.button(strings.hand.fist).click();
    await cockpit.untilTouching();
    await cockpit.tab("expert");
    await cockpit.fieldLike(strings.object.sizes["diameter_mm"]!).fill("68"); // the shown hand begins at the open hand again
    await cockpit.button(strings.object.use).click();
    const digits = await until("digits that began inside", () => stream.newest!.opening.length > 0 && stream.newest!.opening, () => cockpit.brief());
    await until("the line names them", async () => (await line.textContent()) === openingsText(digits), async () => `it says "${await line.textContent()}"`);
    for (const [width, height] of kSizes) {
      await page.setViewportSize({ width, height });
      expect.soft(await page.evaluate(faultsOfLayout), `${width} x ${height}`).toEqual([]);
      await shoot(page, `silent_digits_${width}`);
    }
    await page.setViewportSize(small.viewport!);
    // The operator confirms that one of them is pushed out. Sliders do not follow a force.
    const phase = (wanted: Opening_Phase) => () => stream.newest!.opening.some((opening) => opening.phase === wanted);
    await until("forces are on", () => page.locator(".silent-digits button").isVisible(), () => cockpit.brief());
    await page.locator(".silent-digits button").click();
    expect(stream.newest!.opening.every((opening) => opening.phase === Opening_Phase.UNCONFIRMED)).toBe(true);
    await shoot(page, "push_out");
    await page.locator(".opening-choices button").first().click();
    await until("it is pushed", phase(Opening_Phase.CONFIRMED), () => cockpit.brief());
    await until("it has not followed", phase(Opening_Phase.NOT_FOLLOWED), () => cockpit.brief());
    await until("the line says so", async () => (await line.textContent())!.includes("did not follow"));
    await cockpit.tab("touch");
    await cockpit.button(strings.hand.open).click();
    await until("the line is gone", async () => (await line.textContent()) === "" && stream.newest!.opening.length === 0, () => cockpit.brief());
  });

  it("give the hand back to the patient", async () => {
    await cockpit.setPatient(true);
    await until("no sliders", async () => (await joints().count()) === 0);
    await cockpit.untilRunning();
    const still = cockpit.stream.newest!.hcpAngle;
    await until("the patient's hand moves", () => cockpit.stream.newest!.hcpAngle.some((now, joint) => Math.abs(now - still[joint]!) > 0.05));
  });
});
