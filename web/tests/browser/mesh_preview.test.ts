// SPDX-License-Identifier: Apache-2.0
// The picture of a mesh of one's own before it is used: there is one, it turns, and it stands as the chosen axis says.
import { expect, it } from "vitest";
import { strings } from "../../src/strings";
import { asFile, cube } from "./support/meshes";
import { differing, shoot } from "./support/pictures";
import { small, stage } from "./support/stage";
import { until } from "./support/until";

const play = stage();
const words = strings.object;

it("a mesh of one's own is seen before it is used, from all sides", async () => {
  const cockpit = await play.open((await play.station("grasp_box")).url, small);
  const { page, errors } = cockpit;
  await cockpit.untilRunning();
  await cockpit.openOwnObject();
  await page.getByLabel(words.file, { exact: true }).setInputFiles(asFile("cube.stl", cube(60)));
  await cockpit.fieldLike(words.size).fill("60");
  const frame = page.locator(".mesh-preview-frame");
  const empty = await frame.screenshot();
  await cockpit.button(words.upload).click();
  await until("a picture", async () => ((await cockpit.preview())?.frames ?? 0) > 0);
  const first = await frame.screenshot();
  expect(await differing(page, empty, first)).toBeGreaterThan(0.2);
  await page.getByRole("application", { name: words.preview }).focus();
  for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowRight"); // an eighth of a turn
  await until("the cube from another side", async () => (await differing(page, first, await frame.screenshot())) > 0.05);
  await shoot(page, "mesh_preview");
  expect(errors).toEqual([]);
});
