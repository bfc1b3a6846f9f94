// SPDX-License-Identifier: Apache-2.0
// Pictures of the page on a tablet, a projector and a telephone, dark and light.
import type { BrowserContextOptions } from "playwright-core";
import { beforeAll, describe, it } from "vitest";
import { strings } from "../../src/strings";
import type { CockpitPage } from "./support/cockpit_page";
import { shootReadable } from "./support/readable";
import { stiffnessKey } from "./support/settings";
import { stage, type Station } from "./support/stage";
import { until } from "./support/until";

const kInPlots = 0.25; // [s] of the station
const play = stage();
let station: Station;

beforeAll(async () => {
  station = await play.station("first_touch", { [stiffnessKey]: "2.2" });
});

const looks: readonly { name: string; options: BrowserContextOptions; act?: (cockpit: CockpitPage) => Promise<void> }[] = [
  { name: "20_light", options: { colorScheme: "light" } },
  { name: "21_tablet", options: { viewport: { width: 1024, height: 768 }, hasTouch: true, isMobile: true } },
  { name: "22_tablet_upright_light", options: { viewport: { width: 768, height: 1024 }, hasTouch: true, isMobile: true, colorScheme: "light" } },
  { name: "23_projector_large", options: { viewport: { width: 1920, height: 1080 } }, act: (cockpit) => cockpit.switch(strings.look.large).click() },
  { name: "24_laptop_large", options: { viewport: { width: 1280, height: 720 } }, act: (cockpit) => cockpit.switch(strings.look.large).click() },
  { name: "25_telephone", options: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true } },
];

describe("the page looks right", () => {
  for (const { name, options, act } of looks) {
    it(name, async () => {
      const cockpit = await play.open(station.url, options);
      await cockpit.untilRunning();
      await act?.(cockpit);
      await until("shaking", async () => (await cockpit.verdict()) === "shakes", () => cockpit.brief());
      await cockpit.untilLater(kInPlots);
      await shootReadable(cockpit, name);
      await cockpit.page.context().close();
      await play.freeControl(station);
    });
  }
});
