// SPDX-License-Identifier: Apache-2.0
// A mesh of one's own: a good one becomes the object, a broken one is refused in words that help, and nothing changes.
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { asFile, cube, noise } from "./support/meshes";
import { shoot } from "./support/pictures";
import { valueOf } from "./support/settings";
import { stage, unseen } from "./support/stage";
import { until } from "./support/until";

const words = strings.object;
const kSeed = 20261122;
const kCube = 60; // [mm]; the patient of this scene has to reach it

const play = stage();
let cockpit: CockpitPage;

beforeAll(async () => {
  cockpit = await play.open((await play.station("grasp_box")).url, unseen);
  await cockpit.untilRunning();
  await cockpit.openOwnObject();
});

/// What the page says of a file that was sent.
async function upload(name: string, bytes: Buffer, sizeMm: string, unit = "mm"): Promise<{ verdict: string; all: string; mayUse: boolean }> {
  const { page } = cockpit;
  await page.getByLabel(words.file, { exact: true }).setInputFiles(asFile(name, bytes));
  await cockpit.fieldLike(words.size).fill(sizeMm);
  if (sizeMm === "0") await cockpit.choose(words.unit, unit);
  await cockpit.button(words.upload).click();
  const verdict = page.getByRole("status").filter({ hasText: new RegExp(`^(${words.good}|${words.bad})$`) });
  await verdict.waitFor();
  return { verdict: await verdict.innerText(), all: await page.locator(".upload .import").innerText(), mayUse: await cockpit.button(words.useMesh).isVisible() };
}

/// Extent of the object's mesh as the station serves it [m].
async function objectExtent(): Promise<number[]> {
  const { position } = (await cockpit.geometry()).object!;
  return [0, 1, 2].map((axis) => {
    const values = position.filter((_, i) => i % 3 === axis);
    return Math.max(...values) - Math.min(...values);
  });
}

describe("an uploaded mesh", () => {
  it("is refused in the host's words if it is none, and nothing changes", async () => {
    const { geometry, value } = cockpit.stream.state!;
    const refused = await upload("noise.stl", noise(5000, kSeed), "50");
    console.log(`seed ${kSeed}: ${refused.all.replaceAll("\n", " | ")}`);
    expect(refused.verdict).toBe(words.bad);
    expect(refused.all, "what is wrong, and what to do").toMatch(/stl.*export it again/s);
    expect(refused.mayUse).toBe(false);
    await cockpit.stream.next(30);
    expect(cockpit.stream.state!.geometry).toBe(geometry);
    expect(cockpit.stream.state!.value).toEqual(value);
  });

  it("is refused if its unit makes it as large as a house", async () => {
    const { geometry } = cockpit.stream.state!;
    const refused = await upload("house.stl", cube(kCube), "0", "m");
    console.log(refused.all.replaceAll("\n", " | "));
    expect(refused.verdict).toBe(words.bad);
    expect(refused.mayUse).toBe(false);
    expect(cockpit.stream.state!.geometry).toBe(geometry);
  });

  it("tells what it found in one with a hole", async () => {
    const open = await upload("open.stl", cube(kCube, 1), "0");
    console.log(open.all.replaceAll("\n", " | "));
    expect(open.verdict).toBe(words.good);
    expect(open.all).toContain(words.findings);
    expect(open.all).toMatch(/open|hole|boundary/i);
  });

  it("becomes the object that the hand meets", async () => {
    const { geometry } = cockpit.stream.state!;
    const good = await upload("cube.stl", cube(kCube), "0");
    console.log(good.all.replaceAll("\n", " | "));
    expect(good.verdict).toBe(words.good);
    expect(good.all, "the report of the import").toMatch(/triangles/i);
    await cockpit.button(words.useMesh).click();
    await cockpit.untilState("a new geometry", (state) => state.geometry !== geometry && valueOf(state, "objects.0.kind") === '"file"' && !state.stationGone && state.busy === "");
    for (const extent of await objectExtent()) expect(extent).toBeCloseTo(kCube / 1000, 5);
    await until("the page shows that geometry", async () => (await cockpit.state())!.geometry === cockpit.stream.state!.geometry);
    await cockpit.untilRunning();
    await cockpit.untilTouching();
    await until("an arrow", async () => (await cockpit.probe())!.arrows.length > 0);
  });

  it("is held by a grasp that is planned for it", async () => {
    const { geometry } = cockpit.stream.state!;
    await cockpit.tab("expert");
    await cockpit.choose(strings.grasp.type, "tripod");
    await cockpit.untilState("another wrist", (state) => state.geometry !== geometry && valueOf(state, "grasp.type") === '"tripod"' && !state.stationGone && state.busy === "");
    await cockpit.untilRunning();
    // The end joints of thumb, index and middle finger.
    await until(
      "three fingertips press",
      () => [2, 5, 8].every((segment) => cockpit.stream.newest?.contact.some((one) => one.segment === segment && one.touching && one.force > 0.2)),
      () => cockpit.brief(),
    );
    await until("the page shows the type", async () => (await cockpit.page.getByRole("combobox", { name: strings.grasp.type, exact: true }).innerText()) === strings.grasp.types["tripod"]);
    await cockpit.page.getByRole("combobox", { name: strings.grasp.type, exact: true }).scrollIntoViewIfNeeded();
    await shoot(cockpit.page, "planned_grasp");
  });

  it("is held by the sliders' hand, too, which closes as planned", async () => {
    await cockpit.setPatient(false);
    await cockpit.button(strings.hand.grasp).click();
    const { value } = cockpit.stream.state!;
    const { jointName } = await cockpit.geometry();
    for (const [joint, name] of jointName.entries()) {
      const wanted = (Number(value.find((one) => one.key === `motion.angle_deg.${name}`)!.value) * Math.PI) / 180;
      const angle = () => cockpit.stream.newest?.hcpAngle[joint] ?? NaN;
      await until(`${name} at ${wanted.toFixed(2)} rad`, () => Math.abs(angle() - wanted) < 0.01, () => `it is at ${angle().toFixed(3)}`);
    }
    await cockpit.untilTouching();
  });
});
