// SPDX-License-Identifier: Apache-2.0
// The program is killed: the page must not look alive. It comes back: the page does, too.
import { expect, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { differing } from "./support/pictures";
import { small, stage, type OwnStation } from "./support/stage";
import { until } from "./support/until";

declare global {
  interface Window {
    countsFrames?: boolean;
    framesUntilGrey?: number; // of the screen, from the end of a connection on, the first one since countsFrames was set
  }
}

const play = stage();
let cockpit: CockpitPage;
let second: OwnStation;

/// In the page, before anything of it runs.
function countFrames(): void {
  const Own = window.WebSocket;
  window.WebSocket = class extends Own {
    constructor(url: string | URL, protocols?: string | string[]) {
      super(url, protocols);
      this.addEventListener("close", () => {
        if (!window.countsFrames) return;
        let frames = 0;
        const look = (): void => {
          if (window.phalanx.view()?.lost) window.framesUntilGrey ??= frames;
          else requestAnimationFrame(look);
          ++frames;
        };
        requestAnimationFrame(look);
      });
    }
  };
}

it("greys the hand before the next frame and says so when the program is gone, and comes back by itself", async () => {
  const first = await play.ownStation();
  cockpit = await play.open(first.url, small);
  await cockpit.page.addInitScript(countFrames);
  await cockpit.page.reload();
  await cockpit.ready();
  const band = cockpit.page.getByRole("alert").filter({ hasText: strings.lost.closed });
  const root = cockpit.page.locator("html");
  await cockpit.untilRunning();
  await until("a picture that lives, with arrows", async () => {
    const { lost, arrows } = (await cockpit.probe())!;
    return !lost && arrows.length > 0 && !(await cockpit.lost()) && !(await band.isVisible());
  }, () => cockpit.brief());
  const view = cockpit.page.getByRole("application", { name: strings.view.label });
  const alive = await view.screenshot();

  await cockpit.page.evaluate(() => void (window.countsFrames = true)); // a connection that was cut while the page came up is another one
  await first.program.kill();
  await until("the page knows", () => cockpit.lost());
  await until("the picture is drawn as lost", async () => (await cockpit.probe())!.lost);
  const probe = (await cockpit.probe())!;
  expect(probe.arrows, "arrows would look alive").toEqual([]);
  expect(await until("frames counted", () => cockpit.page.evaluate(() => window.framesUntilGrey)), "frames of the old picture").toBe(0);
  await until("words over the view", () => band.isVisible());
  expect(await root.getAttribute("data-lost")).toBe("true");
  expect(await cockpit.verdict()).toBe("unknown");
  expect(await cockpit.page.getByRole("group", { name: strings.forcePerDigit }).innerText()).not.toMatch(/\d/);
  await until("controls that say why they are off", async () => cockpit.stiffnessField.isDisabled());
  expect(await cockpit.page.getByText(strings.role.offline).isVisible()).toBe(true);
  const dead = await view.screenshot();
  const changed = await differing(cockpit.page, alive, dead);
  console.log(`${(100 * changed).toFixed(1)} % of the picture's pixels changed when it went grey`);
  expect(changed).toBeGreaterThan(0.02);
  const frozen = await cockpit.page.evaluate(() => window.phalanx.tick()!.tick);

  // Stop is still there, and honest.
  await cockpit.stopButton.click();
  await until("the page says that Stop did not get through", async () => cockpit.page.getByText(strings.stop.failed).isVisible());

  const connections = cockpit.stream.connections;
  second = await play.ownStation([], first.port);
  expect(second.url).toBe(first.url);
  await until("the page is back", async () => !(await cockpit.lost()) && !(await cockpit.probe())!.lost, () => cockpit.brief());
  expect(cockpit.stream.connections).toBeGreaterThan(connections);
  await until("the words are gone", async () => !(await band.isVisible()) && (await root.getAttribute("data-lost")) === "false", () => cockpit.brief());
  await until("ticks of the new station", async () => {
    const tick = await cockpit.page.evaluate(() => window.phalanx.tick()!);
    return cockpit.stream.tick(tick.tick) !== undefined && tick.tick !== frozen;
  });

  // The stop that nobody confirmed is still owed: the new station gets it.
  await cockpit.untilStopped();
  await until("the failure is no longer said", async () => !(await cockpit.page.getByText(strings.stop.failed).isVisible()));
  await cockpit.button(strings.stop.resume).click();
  await cockpit.untilRunning();
  await cockpit.untilTouching();
  await until("arrows again", async () => (await cockpit.probe())!.arrows.length > 0);
  expect(await cockpit.stiffnessField.isEnabled()).toBe(true);
});

it("says so when the line stands but nothing new comes", async () => {
  await cockpit.untilRunning();
  second.program.signal("SIGSTOP");
  await until("the page knows", () => cockpit.lost());
  await until("the picture is drawn as lost", async () => (await cockpit.probe())!.lost);
  await until("words over the view", async () => cockpit.page.getByText(strings.lost.stale, { exact: true }).or(cockpit.page.getByText(strings.lost.closed, { exact: true })).isVisible());
  second.program.signal("SIGCONT");
  await until("it goes on", async () => !(await cockpit.lost()) && !(await cockpit.probe())!.lost, () => cockpit.brief());
});
