// SPDX-License-Identifier: Apache-2.0
// The switch of smoothing. It turns on the method that the scene is made for, and turns off no other stabiliser.
import { keyOf } from "../state/keys";
import { quote, unquote } from "../state/toml";
import { strings } from "../strings";
import type { Change } from "../wire/host";
import type { App } from "./app";
import { switchRow } from "./setting_controls";

export const kMethod = "stabiliser.method";

export function stabiliserInForce(app: App): string {
  return unquote(app.store.value(kMethod));
}

/// The methods that the switch turns on and off. Both go over in contact, as "none" does.
const kSmoothing: readonly string[] = ["smoothing", "rise_only"];
export const smoothingIsOn = (app: App): boolean => kSmoothing.includes(stabiliserInForce(app));

/// @returns the method of a scene that states none, as written in a file
const defaultMethod = (app: App) => keyOf(app.store.welcome, kMethod)?.defaultValue ?? "";

/// @returns the method that the switch turns on, as written in a file: the papers' where the scene states a bound on the fall, else the default
function methodTurnedOn(app: App): string {
  const boundsFall = app.store.state?.value.some((one) => one.key.startsWith("smoothing.min_n")) ?? false;
  return boundsFall ? quote("smoothing") : defaultMethod(app);
}

export function smoothingSwitch(app: App): HTMLElement {
  const words = strings.calm;
  const changes = (on: boolean): readonly Change[] => [[kMethod, on ? methodTurnedOn(app) : quote("none")]];
  const blocked = () => (smoothingIsOn(app) || stabiliserInForce(app) === "none" ? "" : words.smoothingOther);
  return switchRow(app, words.smoothing, words.smoothingHint, () => smoothingIsOn(app), changes, blocked);
}
