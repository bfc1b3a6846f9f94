// SPDX-License-Identifier: Apache-2.0
// The whole of it without a mouse. Focus is moved with Tab only, and has to be seen.
import { beforeAll, describe, expect, it } from "vitest";
import { HandSource } from "../../src/gen/phalanx/cockpit_pb";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { asFile, cube } from "./support/meshes";
import { differing } from "./support/pictures";
import { stiffnessKey, valueOf } from "./support/settings";
import { small, stage } from "./support/stage";
import { until } from "./support/until";

const kMostTabs = 80;
const kFlightMs = 400; // camera_rig.ts: so long the camera is on its way, by the page's clock
const play = stage();
let cockpit: CockpitPage;
let seen: string[] = [];

beforeAll(async () => {
  cockpit = await play.open((await play.station("first_touch")).url, { ...small, reducedMotion: "no-preference" });
  cockpit.page.on("filechooser", () => undefined); // the browser reports a file chooser only once asked, and just before the key may be too late
  await cockpit.untilRunning();
});

/// What has the focus: its role and name as a screen reader would say them, and how it is marked.
function focused(): Promise<{ name: string; tag: string; marked: boolean }> {
  return cockpit.page.evaluate(() => {
    const element = document.activeElement as HTMLElement;
    const label = element instanceof HTMLInputElement || element instanceof HTMLSelectElement ? element.labels?.[0]?.innerText : "";
    const style = getComputedStyle(element);
    return {
      name: element.getAttribute("aria-label") ?? (label || element.innerText || "").trim().split("\n")[0] ?? "",
      tag: element.tagName.toLowerCase(),
      marked: (style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2) || style.boxShadow !== "none",
    };
  });
}

/// Presses Tab until what has the focus is the one. Each stop on the way must be visible as such.
async function tabUntil(what: string, is: (now: { name: string; tag: string }) => boolean | Promise<boolean>): Promise<void> {
  seen = [];
  for (let i = 0; i < kMostTabs; ++i) {
    await cockpit.page.keyboard.press("Tab");
    const now = await focused();
    seen.push(`${now.tag} ${now.name}`);
    if (now.tag !== "body") expect(now.marked, `the focus cannot be seen on ${now.tag} "${now.name}"`).toBe(true);
    if (await is(now)) return;
  }
  throw new Error(`Tab never came to ${what}; it came to ${seen.join("; ")}`);
}

const tabTo = (name: string, tag: string) => tabUntil(`${tag} "${name}"`, (now) => now.name === name && now.tag === tag);

describe("by keyboard", () => {
  it("makes the wall stiff until the hand shakes", async () => {
    await tabTo(strings.force.stiffnessField, "input");
    await cockpit.page.keyboard.press("Control+A");
    await cockpit.page.keyboard.type("2.2");
    await cockpit.page.keyboard.press("Enter");
    await until("the stiffness", () => cockpit.stream.newest!.stiffness === 2200, () => cockpit.brief());
    await until("the light says shaking", async () => (await cockpit.verdict()) === "shakes", () => cockpit.brief());
  });

  it("moves the slider by arrow keys", async () => {
    await tabTo(strings.force.stiffness, "input");
    const before = cockpit.stream.newest!.stiffness;
    await cockpit.page.keyboard.press("ArrowRight");
    await cockpit.page.keyboard.press("PageUp");
    await until("a stiffer wall", () => cockpit.stream.newest!.stiffness > before, () => `${cockpit.stream.newest!.stiffness} N/m`);
  });

  it("switches smoothing on with Enter, and the hand settles", async () => {
    await tabTo(strings.calm.smoothing, "button");
    await cockpit.page.keyboard.press("Enter");
    await cockpit.untilState("smoothing in force", (state) => valueOf(state, "stabiliser.method") === '"smoothing"');
    await until(
      "steady",
      async () => (await cockpit.verdict()) === "steady" && !cockpit.stream.ticks.slice(-60).some((tick) => tick.contact.some((contact) => contact.oscillating)),
      () => cockpit.brief(),
    );
  });

  it("chooses views by 1 to 4, zooms by + and -, turns by arrow keys", async () => {
    const view = cockpit.page.getByRole("application", { name: strings.view.label });
    await cockpit.page.evaluate(() => (document.activeElement as HTMLElement).blur());
    const pageTime = () => cockpit.page.evaluate(() => performance.now());
    const look = async () => {
      const begun = await pageTime();
      await until("the camera has arrived", async () => (await pageTime()) - begun > kFlightMs);
      const { frames } = (await cockpit.probe())!;
      await until("two more frames", async () => (await cockpit.probe())!.frames > frames + 1);
      return view.screenshot();
    };
    let before = await look();
    for (const key of ["2", "3", "4", "1", "+", "-"]) {
      await cockpit.page.keyboard.press(key);
      if (key === "+") for (let i = 0; i < 3; ++i) await cockpit.page.keyboard.press(key);
      if (key === "-") for (let i = 0; i < 6; ++i) await cockpit.page.keyboard.press(key);
      const after = await look();
      const changed = await differing(cockpit.page, before, after);
      console.log(`${key}: ${(100 * changed).toFixed(1)} % of the pixels change`);
      expect(changed, `key ${key}`).toBeGreaterThan(0.05);
      before = after;
    }
    await cockpit.page.keyboard.press("1"); // near again
    before = await look();
    await view.focus();
    for (let i = 0; i < 12; ++i) await cockpit.page.keyboard.press("ArrowLeft"); // by 55 degrees
    expect(await differing(cockpit.page, before, await look()), "arrow keys").toBeGreaterThan(0.05);
  });

  it("lists the keys, and gives the focus back", async () => {
    await tabTo(strings.look.help, "button");
    await cockpit.page.keyboard.press("?");
    const dialog = cockpit.page.getByRole("dialog", { name: strings.help.title });
    await dialog.waitFor();
    for (const [key] of strings.help.rows) expect(await dialog.innerText()).toContain(key);
    expect(await dialog.evaluate((element) => element.contains(document.activeElement))).toBe(true);
    await cockpit.page.keyboard.press("Tab");
    expect((await focused()).name).toBe(strings.look.close);
    await cockpit.page.keyboard.press("Enter");
    expect(await dialog.count()).toBe(0);
    expect((await focused()).name).toBe(strings.look.help);
  });

  it("stops by Esc in a dialog, and the dialog hides no Stop", async () => {
    await cockpit.page.keyboard.press("?");
    await cockpit.page.keyboard.press("Escape");
    await cockpit.untilStopped();
    expect(await cockpit.stopButton.isVisible()).toBe(true);
    await cockpit.stopButton.click({ trial: true }); // would fail if something lay over it
    await tabTo(strings.stop.resume, "button");
    await cockpit.page.keyboard.press("Enter");
    await cockpit.untilState("resumed", (state) => !state.heldStopped);
  });

  it("goes from tab to tab by arrow keys", async () => {
    await tabTo(strings.tabs.touch, "button");
    for (const name of [strings.tabs.expert, strings.tabs.device, strings.tabs.people, strings.tabs.touch]) {
      await cockpit.page.keyboard.press("ArrowRight");
      expect((await focused()).name).toBe(name);
      expect(await cockpit.page.getByRole("tab", { name, exact: true }).getAttribute("aria-selected")).toBe("true");
    }
  });

  it("finds a setting in the list of all and sets it", async () => {
    const { keyboard } = cockpit.page;
    await tabTo(strings.tabs.touch, "button");
    await keyboard.press("ArrowRight");
    await tabTo(strings.settings.search, "input");
    await keyboard.type(stiffnessKey);
    await tabUntil(`the field of ${stiffnessKey}`, () =>
      cockpit.page.evaluate((key) => {
        const focus = document.activeElement;
        return focus?.tagName === "INPUT" && focus.closest("li")?.querySelector("code")?.textContent === key;
      }, stiffnessKey),
    );
    await keyboard.press("Control+A");
    await keyboard.type("0.7");
    await keyboard.press("Enter");
    await until("the stiffness", () => cockpit.stream.newest!.stiffness === 700, () => cockpit.brief());
    await tabTo(strings.tabs.expert, "button");
    await keyboard.press("ArrowLeft");
  });

  it("saves the curves", async () => {
    for (const [name, ending] of [[strings.plots.csvLong, ".csv"], [strings.plots.svgLong, ".svg"], [strings.plots.pngLong, ".png"]] as const) {
      await tabTo(name, "button");
      const download = cockpit.page.waitForEvent("download");
      await cockpit.page.keyboard.press("Enter");
      expect((await download).suggestedFilename().endsWith(ending)).toBe(true);
    }
  });

  it("moves a joint by its slider", async () => {
    const { keyboard } = cockpit.page;
    await tabTo(strings.hand.patient, "button");
    await keyboard.press("Enter");
    await cockpit.untilState("the sliders", (state) => state.source === HandSource.HAND_SLIDERS && state.slider.length > 0 && !state.stationGone);
    const smallest = (await cockpit.geometry()).jointMin[0]!;
    const angle = () => cockpit.stream.newest!.hcpAngle[0]!;
    await tabTo(strings.hand.single, "summary");
    await keyboard.press("Enter");
    await tabTo(strings.hand.joints.thumb[0]!, "input");
    await keyboard.press("Home");
    await until("the joint at the end of its range", () => Math.abs(angle() - smallest) < 0.02, () => `${angle()} rad`);
    await keyboard.press("PageUp");
    await until("the joint on its way back", () => angle() > smallest + 0.02, () => `${angle()} rad`);
  });

  it("uploads a mesh and uses it", async () => {
    const { keyboard } = cockpit.page;
    const words = strings.object;
    await tabUntil("the card of the user's own object", (now) => now.name.startsWith(words.own) && now.tag === "button");
    await keyboard.press("Enter");
    await tabTo(words.choose, "button");
    const chooser = cockpit.page.waitForEvent("filechooser");
    await keyboard.press("Enter");
    await (await chooser).setFiles(asFile("cube.stl", cube(60)));
    await tabUntil("the mesh's size", (now) => now.name.startsWith(words.size) && now.tag === "input");
    await keyboard.press("Control+A");
    await keyboard.type("60"); // mm; a larger one goes through the open hand
    await tabTo(words.upload, "button");
    await keyboard.press("Enter");
    await cockpit.page.getByRole("status").filter({ hasText: "cube.stl" }).waitFor();
    await tabTo(words.useMesh, "button");
    await keyboard.press("Enter");
    await cockpit.untilState("the mesh in force", (state) => valueOf(state, "objects.0.kind") === '"file"');
  });
});
