// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { calibrationDialog } from "../../../src/panels/calibration_dialog";
import { devicePanel } from "../../../src/panels/device_panel";
import { strings } from "../../../src/strings";
import { fakeApp, kMe } from "./fake_app";

const words = strings.device;

describe("a device without a watchdog", () => {
  it("is said to hold the finger, and to be for trying out", () => {
    const fake = fakeApp();
    const panel = devicePanel(fake.app, calibrationDialog(fake.app, () => {}));
    const warning = [...panel.querySelectorAll<HTMLElement>(".warning")].find((one) => one.textContent === words.holdsWithoutHost)!;
    fake.state({ operatorPage: kMe, holdsWithoutHost: false });
    expect([warning.hidden, panel.textContent?.includes(words.letsGo)]).toEqual([true, true]);
    fake.state({ operatorPage: kMe, holdsWithoutHost: true });
    expect([warning.hidden, panel.textContent?.includes(words.noWatchdog)]).toEqual([false, true]);
  });
});
