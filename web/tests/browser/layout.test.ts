// SPDX-License-Identifier: Apache-2.0
// Where things stand, at the sizes of screens that people have: nothing lies over anything, and Stop is in sight whatever is open.
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { faultsOfLayout, kSizes } from "./support/layout";
import { asFile, cube } from "./support/meshes";
import { stage, unseen } from "./support/stage";

const kScenes = 19; // of exercises, that are shipped
const play = stage();
let cockpit: CockpitPage;

beforeAll(async () => {
  cockpit = await play.open((await play.station("grasp_box")).url, unseen);
  await cockpit.untilRunning();
});

const expectNoFaults = async (what: string) => expect.soft(await cockpit.page.evaluate(faultsOfLayout), what).toEqual([]);

describe.each(kSizes)("at %i x %i", (width, height) => {
  it("everything is inside its place and uncovered, and Stop is in sight whatever is open", async () => {
    const { page } = cockpit;
    await page.setViewportSize({ width, height });
    for (const tab of ["expert", "device", "people", "touch"] as const) {
      await cockpit.tab(tab);
      await expectNoFaults(tab);
    }
    const summary = page.getByText(strings.view.partsMenu, { exact: true });
    await summary.click();
    await expectNoFaults("with the menu of what is shown");
    await summary.click();
    // A mesh file is chosen by a field that only a screen reader sees.
    await cockpit.openOwnObject();
    const file = page.getByLabel(strings.object.file, { exact: true });
    await file.setInputFiles(asFile("cube.stl", cube(40)));
    await file.focus();
    await expectNoFaults("with the upload");
    await cockpit.button(strings.look.close).click();
    await cockpit.button(strings.scene.all(kScenes)).click();
    await expectNoFaults("with all scenes");
    await cockpit.button(strings.scene.fewer).click();
    // A notice of a change that is not this page's own.
    await page.evaluate(() => fetch("marker", { method: "POST", body: "stimulus 3" }));
    await page.locator(".toast").first().waitFor();
    await expectNoFaults("with notices");
    await page.locator(".toast button").evaluateAll((buttons) => buttons.forEach((button) => (button as HTMLButtonElement).click())); // sizes follow faster than notices go
    // A question: this page gives control back and takes it again.
    await cockpit.tab("people");
    await cockpit.button(strings.role.release).click();
    await cockpit.button(strings.role.take).first().click();
    await expectNoFaults("with a question");
    await page.getByRole("dialog").getByRole("button", { name: strings.role.confirm, exact: true }).click();
    await cockpit.button(strings.role.release).waitFor();
  });
});
