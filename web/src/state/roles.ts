// SPDX-License-Identifier: Apache-2.0
// The role of this page and what it may do.
import { HandSource, type State, type Welcome } from "../gen/phalanx/cockpit_pb";

/// mine: this page operates. Otherwise the reason: no connection; the address may only watch; another page operates; no page operates.
export type Role = "mine" | "offline" | "watch_only" | "other" | "nobody";

export function roleOf(connected: boolean, welcome: Welcome | undefined, state: State | undefined): Role {
  if (!connected || !welcome || !state) return "offline";
  if (!welcome.mayOperate) return "watch_only";
  if (state.operatorPage === welcome.page) return "mine";
  return state.operatorPage === 0 ? "nobody" : "other";
}

export const mayChange = (role: Role): boolean => role === "mine";
export const mayTake = (role: Role): boolean => role === "other" || role === "nobody";

/// A device on a wire, whose sensors the wearer moves; also a simulated one behind the link.
export const isOnWire = (state: State | undefined): boolean => state?.source === HandSource.HAND_DEVICE;

export const mayCalibrate = (role: Role, state: State | undefined): boolean => mayChange(role) && isOnWire(state);
