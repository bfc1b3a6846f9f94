// SPDX-License-Identifier: Apache-2.0
// Where things stand, at the sizes of screens that people have: nothing lies over anything, and Stop is in sight whatever is open.
import { beforeAll, describe, expect, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { asFile, cube } from "./support/meshes";
import { stage, unseen } from "./support/stage";

const kSizes: readonly (readonly [width: number, height: number])[] = [
  [1920, 1080], [1440, 900], [1366, 768], [1150, 760], [1024, 768], [390, 844],
  [720, 450], [960, 540], // 1440 x 900 and 1920 x 1080 at 200 %
];

const play = stage();
let cockpit: CockpitPage;

beforeAll(async () => {
  cockpit = await play.open((await play.station("grasp_box")).url, unseen);
  await cockpit.untilRunning();
});

/// Runs in the page. @returns what is wrong there, in words; nothing: all is well
function faultsOfLayout(): string[] {
  const kSlack = 1; // [px], for fractions
  const faults: string[] = [];
  const say = (what: string) => faults.push(what);
  const nameOf = (element: Element) => `${element.tagName.toLowerCase()} "${(element.getAttribute("aria-label") ?? element.textContent ?? "").trim().slice(0, 30)}"`;
  const within = (inner: DOMRect, outer: { left: number; right: number; top: number; bottom: number }) =>
    inner.left >= outer.left - kSlack && inner.right <= outer.right + kSlack && inner.top >= outer.top - kSlack && inner.bottom <= outer.bottom + kSlack;
  const screen = { left: 0, top: 0, right: innerWidth, bottom: innerHeight };
  const shown = (element: Element) => element.checkVisibility({ visibilityProperty: true }) && element.getBoundingClientRect().width > 1;
  /// Nothing but the element itself is at its middle and near its left and right ends.
  const uncovered = (element: Element) => {
    const box = element.getBoundingClientRect();
    return [0.1, 0.5, 0.9].every((share) => {
      const hit = document.elementFromPoint(box.left + share * box.width, box.top + box.height / 2);
      return hit !== null && (element.contains(hit) || hit.contains(element));
    });
  };

  const root = document.scrollingElement!;
  root.scrollTo(0, 0);
  root.scrollTo(10_000, 10_000);
  if (root.scrollLeft !== 0 || root.scrollTop !== 0) say(`the document scrolls by ${root.scrollLeft}, ${root.scrollTop}`);
  root.scrollTo(0, 0);
  for (const scroller of document.querySelectorAll(".tab-panels, .content, .dock, .dialog-body")) {
    if (scroller.scrollWidth <= scroller.clientWidth + kSlack || !shown(scroller)) continue;
    const edge = scroller.getBoundingClientRect().right;
    const beyond = [...scroller.querySelectorAll("*")].filter((inner) => shown(inner) && inner.getBoundingClientRect().right > edge + kSlack).map(nameOf);
    say(`.${scroller.className} is ${scroller.scrollWidth - scroller.clientWidth} px too wide: ${beyond.slice(0, 4).join(", ")}`);
  }
  const question = document.querySelector(".dialogs:not([hidden])"); // what it lies over waits for the answer
  for (const control of document.querySelectorAll("button:enabled, input:enabled:not([type=file]), summary, [role=option]")) {
    if (!shown(control) || control.closest("fieldset:disabled") || (question && !control.closest(".dialog, .dock"))) continue;
    control.scrollIntoView({ block: "nearest", inline: "nearest" });
    const box = control.getBoundingClientRect();
    const around = control.closest(".view-parts-list, .view-frame, .tab-panels, .stop-box, .plots, .toasts, .header, .tabs, .dialog, .role-strip");
    if (!around || !within(box, around.getBoundingClientRect())) say(`${nameOf(control)} is not inside .${around?.className}`);
    if (!within(box, screen)) say(`${nameOf(control)} is not on the screen`);
    if (!uncovered(control)) say(`${nameOf(control)} is covered`);
  }
  const host = document.querySelector(".view-host")!;
  host.scrollIntoView({ block: "nearest" });
  const view = host.getBoundingClientRect();
  for (const over of document.querySelectorAll(".view-cameras, .toasts, .stop-box")) {
    const box = over.getBoundingClientRect();
    if (shown(over) && box.left < view.right && box.right > view.left && box.top < view.bottom - kSlack && box.bottom > view.top + kSlack) say(`.${over.className} lies over the hand`);
  }
  const stop = document.querySelector(".stop")!;
  if (!within(stop.getBoundingClientRect(), screen) || !uncovered(stop)) say("STOP is not wholly in sight");
  return faults;
}

const expectNoFaults = async (what: string) => expect.soft(await cockpit.page.evaluate(faultsOfLayout), what).toEqual([]);

describe.each(kSizes)("at %i x %i", (width, height) => {
  it("everything is inside its place and uncovered, and Stop is in sight whatever is open", async () => {
    const { page } = cockpit;
    await page.setViewportSize({ width, height });
    for (const tab of ["hand", "device", "people", "touch"] as const) {
      await cockpit.tab(tab);
      await expectNoFaults(tab);
    }
    const summary = page.getByText(strings.view.partsMenu, { exact: true });
    await summary.click();
    await expectNoFaults("with the menu of what is shown");
    await summary.click();
    // A mesh file is chosen by a field that only a screen reader sees.
    await cockpit.choose(strings.object.kind, "file");
    const file = page.getByLabel(strings.object.file, { exact: true });
    await file.setInputFiles(asFile("cube.stl", cube(40)));
    await file.focus();
    await expectNoFaults("with the upload");
    await cockpit.choose(strings.object.kind, "box");
    // A notice: this page gives control back and takes it again.
    await cockpit.tab("people");
    await cockpit.button(strings.role.release).click();
    await page.locator(".toast").first().waitFor();
    await expectNoFaults("with notices");
    await cockpit.button(strings.role.take).first().click();
    await expectNoFaults("with a question");
    await page.getByRole("dialog").getByRole("button", { name: strings.role.confirm, exact: true }).click();
    await cockpit.button(strings.role.release).waitFor();
  });
});
