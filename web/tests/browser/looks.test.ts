// SPDX-License-Identifier: Apache-2.0
// Pictures of the page's states, for looking at; and that all of their text can be read.
import { beforeAll, describe, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { asFile, cube, noise } from "./support/meshes";
import { shootReadable } from "./support/readable";
import { stage, type OwnStation } from "./support/stage";
import { until } from "./support/until";

const kInPlots = 0.4; // [s] of the station
const play = stage();
let station: OwnStation; // killed in the end
let cockpit: CockpitPage;

beforeAll(async () => {
  station = await play.ownStation();
  cockpit = await play.open(station.url);
});

async function upload(name: string, bytes: Buffer): Promise<void> {
  const { page } = cockpit;
  if (!(await page.getByRole("dialog").isVisible())) await cockpit.openOwnObject();
  await page.getByLabel(strings.object.file, { exact: true }).setInputFiles(asFile(name, bytes));
  await cockpit.button(strings.object.upload).click();
  const summary = page.getByRole("status").filter({ hasText: name });
  await summary.waitFor();
  await summary.scrollIntoViewIfNeeded();
}

describe("the page looks right", () => {
  it("at first sight", () => shootReadable(cockpit, "01_first"));

  it("in contact", async () => {
    await cockpit.untilRunning();
    await cockpit.untilTouching(1);
    await shootReadable(cockpit, "02_contact");
  });

  it("while it shakes", async () => {
    await cockpit.setStiffness(2.2);
    await until("shaking", async () => (await cockpit.verdict()) === "shakes", () => cockpit.brief());
    await cockpit.untilLater(kInPlots);
    await until("shaking", async () => (await cockpit.verdict()) === "shakes", () => cockpit.brief());
    await shootReadable(cockpit, "03_shaking");
  });

  it("when it has settled", async () => {
    await cockpit.switch(strings.calm.smoothing).click();
    await until("steady", async () => (await cockpit.verdict()) === "steady", () => cockpit.brief());
    await cockpit.untilLater(kInPlots);
    await until("steady", async () => (await cockpit.verdict()) === "steady", () => cockpit.brief());
    await shootReadable(cockpit, "04_settled");
  });

  it("when a change is refused", async () => {
    await cockpit.setStiffness(-1);
    await until("the refusal", async () => (await cockpit.page.getByRole("alert").filter({ hasText: "stiffness" }).count()) > 0);
    await shootReadable(cockpit, "05_refused");
    await cockpit.setStiffness(1);
  });

  it("stopped", async () => {
    await cockpit.stopButton.click();
    await cockpit.untilStopped();
    await until("the page says stopped", async () => (await cockpit.stopBox.textContent())?.includes(strings.safety.stopped), () => cockpit.brief());
    await shootReadable(cockpit, "06_stopped");
    await cockpit.button(strings.stop.resume).click();
  });

  it("with the settings of experts, and with one that was searched", async () => {
    await cockpit.tab("expert");
    await shootReadable(cockpit, "07_expert");
    await cockpit.page.getByRole("searchbox").fill("force");
    await shootReadable(cockpit, "07_settings");
    await cockpit.page.getByRole("searchbox").fill("");
    await cockpit.tab("touch");
  });

  it("with the keys", async () => {
    await cockpit.button(strings.look.help).click();
    await shootReadable(cockpit, "08_keys");
    await cockpit.button(strings.look.close).click();
  });

  it("with a good and with a broken mesh", async () => {
    await upload("cube.stl", cube(40));
    await shootReadable(cockpit, "09_upload_good");
    await upload("noise.stl", noise(5000, 20261122));
    await shootReadable(cockpit, "10_upload_bad");
    await cockpit.button(strings.look.close).click();
  });

  it("with the sliders", async () => {
    await cockpit.setPatient(false);
    await cockpit.openSingleJoints();
    await cockpit.button(strings.hand.fist).click();
    await cockpit.untilAtRest();
    await shootReadable(cockpit, "12_sliders");
  });

  it("with the device, and with who is here", async () => {
    await cockpit.tab("device");
    await shootReadable(cockpit, "13_device");
    await cockpit.tab("people");
    await shootReadable(cockpit, "14_people");
    await cockpit.tab("touch");
  });

  it("for a viewer", async () => {
    const viewer = await play.open(station.url);
    await shootReadable(viewer, "15_viewer");
    await viewer.button(strings.role.take).first().click();
    await shootReadable(viewer, "16_take_control");
    await viewer.button(strings.role.cancel).click();
  });

  it("without the program", async () => {
    const telephone = await play.open(station.url, { viewport: { width: 844, height: 340 }, hasTouch: true, isMobile: true });
    await station.program.kill();
    for (const page of [cockpit, telephone]) {
      await until("the page knows", () => page.lost());
      await until("the picture is drawn as lost", async () => (await page.probe())!.lost);
      await page.page.getByRole("alert").filter({ hasText: strings.lost.closed }).waitFor();
    }
    await shootReadable(cockpit, "17_lost");
    await cockpit.page.keyboard.press("Space");
    await telephone.stopButton.click();
    for (const { page } of [cockpit, telephone]) await until("the failure of Stop", () => page.getByText(strings.stop.failed).isVisible());
    await shootReadable(cockpit, "18_lost_stop");
    await shootReadable(telephone, "26_telephone_sideways");
  });
});
