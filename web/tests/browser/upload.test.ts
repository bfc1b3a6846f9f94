// SPDX-License-Identifier: Apache-2.0
// A mesh of one's own: a good one becomes the object, a broken one is refused in words that help, and nothing changes.
import { beforeAll, describe, expect, it } from "vitest";
import { vector } from "../../src/state/toml";
import { strings } from "../../src/strings";
import type { MeshPreviewProbe } from "../../src/view3d/mesh_preview";
import type { CockpitPage } from "./support/cockpit_page";
import { asFile, box, cube, noise } from "./support/meshes";
import { shoot } from "./support/pictures";
import { valueOf } from "./support/settings";
import { stage, unseen } from "./support/stage";
import { until } from "./support/until";

const words = strings.object;
const kSeed = 20261122;
const kCube = 60; // [mm]; the patient of this scene has to reach it

const play = stage();
let cockpit: CockpitPage;
let held = Promise.resolve(); // what the next upload waits for

// One route for all stories of this file: one that comes and goes with a story may not yet be there when the upload is sent.
beforeAll(async () => {
  cockpit = await play.open((await play.station("grasp_box")).url, unseen);
  await cockpit.page.route("**/mesh?*", async (route) => {
    const gate = held;
    held = Promise.resolve();
    await gate;
    await route.continue().catch(() => {}); // it may have been given up
  });
  await cockpit.untilRunning();
  await cockpit.openOwnObject();
});

interface Outcome {
  readonly ok: boolean;
  readonly summary: string;
  readonly details: string; // whether they are open or not
  readonly mayUse: boolean;
}

async function choose(name: string, bytes: Buffer, sizeMm: string, unit = "mm"): Promise<void> {
  await cockpit.page.getByLabel(words.file, { exact: true }).setInputFiles(asFile(name, bytes));
  await cockpit.fieldLike(words.size).fill(sizeMm);
  if (sizeMm === "0") await cockpit.choose(words.unit, unit);
}

/// What the page says of a file that was sent.
async function outcome(name: string): Promise<Outcome> {
  const { page } = cockpit;
  const summary = page.getByRole("status").filter({ hasText: name });
  await summary.waitFor();
  const all = page.locator(".upload .import");
  return {
    ok: (await all.getAttribute("data-ok")) === "true",
    summary: await summary.innerText(),
    details: (await all.locator("details").textContent()) ?? "",
    mayUse: await cockpit.button(words.useMesh).isVisible(),
  };
}

async function upload(name: string, bytes: Buffer, sizeMm: string, unit = "mm"): Promise<Outcome> {
  await choose(name, bytes, sizeMm, unit);
  await cockpit.button(words.upload).click();
  const said = await outcome(name);
  console.log(`${said.summary} | ${said.details}`);
  return said;
}

/// The drawn preview, once it is as wanted.
async function untilPreview(what: string, is: (preview: MeshPreviewProbe) => boolean = ({ frames }) => frames > 0): Promise<MeshPreviewProbe> {
  return until(`a preview: ${what}`, async () => {
    const preview = await cockpit.preview();
    return preview !== undefined && is(preview) && preview;
  });
}

const useMesh = async () => {
  const { geometry } = cockpit.stream.state!;
  await cockpit.button(words.useMesh).click();
  await cockpit.untilState("a new geometry", (state) => state.geometry !== geometry && valueOf(state, "objects.0.kind") === '"file"' && !state.stationGone && state.busy === "");
};

/// Holds the next upload back on its way. @returns what lets it go on
function heldUpload(): () => void {
  let goOn = () => {};
  held = new Promise<void>((done) => (goOn = done));
  return goOn;
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
    expect(refused.ok, `seed ${kSeed}`).toBe(false);
    expect(refused.summary, "what is wrong, and what to do").toMatch(/^✕? ?noise.stl: .*export it again$/);
    expect(refused.mayUse).toBe(false);
    expect(await cockpit.preview()).toBeUndefined();
    await cockpit.stream.next(30);
    expect(cockpit.stream.state!.geometry).toBe(geometry);
    expect(cockpit.stream.state!.value).toEqual(value);
  });

  it("is refused if its unit makes it as large as a house", async () => {
    const { geometry } = cockpit.stream.state!;
    const refused = await upload("house.stl", cube(kCube), "0", "m");
    expect(refused.ok).toBe(false);
    expect(refused.summary).toContain(words.tooWide("house.stl", "60,000 × 60,000 × 60,000 mm"));
    expect(refused.mayUse).toBe(false);
    expect(cockpit.stream.state!.geometry).toBe(geometry);
  });

  it("tells what it found in one with a hole", async () => {
    const open = await upload("open.stl", cube(kCube, 1), "0");
    expect(open.ok).toBe(true);
    expect(open.summary).toContain(words.sheet("open.stl", "60 × 60 × 60 mm", "10"));
    expect(open.details).toContain(words.findings);
    expect(open.details).toMatch(/open|hole|boundary/i);
    await untilPreview("the open cube");
  });

  it("is shown as the station understood it, and turns by keys and by dragging", async () => {
    const { page } = cockpit;
    const said = await upload("cube.stl", cube(kCube), "0");
    expect(said.summary).toContain(words.closed("cube.stl", "60 × 60 × 60 mm", "12"));
    const preview = await untilPreview("the cube");
    for (const extent of preview.extent) expect(extent).toBeCloseTo(kCube / 1000, 5);
    expect(preview.bar).toBe(0.1);
    const place = page.getByRole("application", { name: words.preview });
    await place.focus();
    for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowRight"); // an eighth of a turn
    const turned = await untilPreview("turned by keys", ({ direction }) => Math.abs(Math.atan2(direction[1], direction[0]) - Math.atan2(preview.direction[1], preview.direction[0]) - Math.PI / 4) < 1e-6);
    const around = (await place.boundingBox())!;
    await page.mouse.move(around.x + around.width / 2, around.y + around.height / 2);
    await page.mouse.down();
    await page.mouse.move(around.x + around.width / 2 + 60, around.y + around.height / 2 + 20);
    await page.mouse.up();
    const dragged = await untilPreview("turned by the mouse", ({ direction }) => direction[2] > turned.direction[2]);
    const { frames } = dragged;
    await page.mouse.move(around.x + around.width / 2, around.y + 10);
    await cockpit.stream.next(30);
    expect((await cockpit.preview())!.frames - frames, "nothing changes: nothing is drawn").toBeLessThanOrEqual(1);
  });

  it("is used without a preview if that is malformed", async () => {
    const { page } = cockpit;
    await page.route("**/mesh?*", async (route) => {
      const response = await route.fetch();
      const answer = (await response.json()) as { preview: { triangle: number[] } };
      answer.preview.triangle[0] = 8;
      await route.fulfill({ response, json: answer });
    }, { times: 1 });
    const said = await upload("cube.stl", cube(kCube), "0");
    expect(said.mayUse).toBe(true);
    await page.getByText(words.previewMissing, { exact: true }).waitFor();
    expect(await cockpit.preview()).toBeUndefined();
  });

  it("is another one if a second file is sent while the first is on its way", async () => {
    const goOn = heldUpload();
    await choose("first.stl", cube(kCube), "0");
    await cockpit.button(words.upload).click();
    await cockpit.page.getByText(words.uploading("first.stl"), { exact: true }).waitFor();
    const said = await upload("second.stl", box([40, 50, 60]), "0");
    goOn();
    expect(said.summary).toContain(words.closed("second.stl", "40 × 50 × 60 mm", "12"));
    const { extent } = await untilPreview("the second file");
    expect(extent[0]).toBeCloseTo(0.04, 5);
  });

  it("is there when the dialog opens again that was closed meanwhile", async () => {
    const goOn = heldUpload();
    await choose("cube.stl", cube(kCube), "0");
    await cockpit.button(words.upload).click();
    await cockpit.page.getByText(words.uploading("cube.stl"), { exact: true }).waitFor();
    await cockpit.button(strings.look.close).click();
    expect(await cockpit.preview()).toBeUndefined();
    const answered = cockpit.page.waitForResponse("**/mesh?*");
    goOn();
    await (await answered).finished();
    expect(await cockpit.preview(), "nothing is drawn in a dialog that is closed").toBeUndefined();
    await cockpit.openOwnObject();
    expect((await outcome("cube.stl")).ok).toBe(true);
    await untilPreview("the cube");
  });

  it("stands in the scene on the side that was chosen, and is touched", async () => {
    const [x, y, z] = [60, 56, 52];
    await upload("slab.stl", box([x, y, z]), "0");
    await untilPreview("z up", ({ frames, up }) => frames > 0 && up === "z");
    await cockpit.button(words.axes.y).click();
    const { extent } = await untilPreview("y up", ({ up }) => up === "y");
    [x, z, y].forEach((wanted, axis) => expect(extent[axis]).toBeCloseTo(wanted / 1000, 5));
    await useMesh();
    expect(vector(valueOf(cockpit.stream.state!, "objects.0.rotation_deg")!)).toEqual([90, 0, 0]);
    (await objectExtent()).forEach((metres, axis) => expect(metres).toBeCloseTo([x, z, y][axis]! / 1000, 5));
    await until("a closed dialog: the answer may come after the new geometry", async () => (await cockpit.preview()) === undefined);
    await cockpit.untilRunning();
    await cockpit.untilTouching();
    await cockpit.openOwnObject();
  });

  it("becomes the object that the hand meets", async () => {
    const good = await upload("cube.stl", cube(kCube), "0");
    expect(good.ok).toBe(true);
    expect(good.details, "the report of the import").toMatch(/triangles/i);
    await useMesh();
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
