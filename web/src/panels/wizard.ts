// SPDX-License-Identifier: Apache-2.0
// The device's tab: what is calibrated, and the ways into the dialog that does it.
import { Calibrate_Step as Step } from "../gen/phalanx/cockpit_pb";
import { isOnWire, mayCalibrate } from "../state/roles";
import { strings } from "../strings";
import { refusal, type App } from "./app";
import type { CalibrationDialog } from "./calibration_dialog";
import { confirmDialog } from "./dialog";
import { button, el, section, setShown, setText } from "./dom";
import { guarded } from "./setting_controls";

const words = strings.calibration;

export function wizardSection(app: App, dialog: CalibrationDialog): HTMLElement {
  const device = button(words.device, () => dialog.askDevice());
  const range = button(words.range, () => dialog.askRange());
  const drop = button(words.dropRange, () => confirmDialog(app, words.dropTitle, words.dropText, words.dropRange, () => void send()));
  const refused = el("p", { class: "refused", role: "alert", hidden: true });
  async function send(): Promise<void> {
    setText(refused, refusal(await app.host.calibrate({ step: Step.DROP_RANGE })));
    setShown(refused, refused.textContent !== "");
  }
  const hint = el("p", { class: "hint" });
  const limits = el("p", { role: "status" });
  const update = () => {
    const { state, role } = app.store;
    const onWire = isOnWire(state);
    const calibrated = (state?.calibration ?? "") !== "";
    device.disabled = !mayCalibrate(role, state);
    range.disabled = device.disabled || !calibrated;
    setText(hint, !onWire ? words.onlyDevice : calibrated ? words.beginHint : words.firstDevice);
    setText(limits, state?.range ? words.limitedBy(state.range) : words.noRange);
    setShown(limits, onWire);
    setShown(drop, (state?.range ?? "") !== "");
    drop.disabled = state?.wizard !== undefined;
  };
  app.store.on(["state", "connection"], update);
  update();
  return section(words.title, limits, hint, refused, guarded(app, el("div", { class: "buttons" }, device, range, drop)));
}
