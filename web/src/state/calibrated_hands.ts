// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import type { Wizard } from "../gen/phalanx/cockpit_pb";
import { TickSchema, type Tick } from "../gen/phalanx/tick_pb";

/// @returns the hands of a calibration as a step that the view can show: the hand as it is, and as a ghost where it is to go. Undefined:
/// there is no hand to show. A range has no pose to go to; its ghost is the hand itself.
export function calibratedHands(wizard: Wizard | undefined): Tick | undefined {
  if (!wizard || wizard.hand.length === 0) return undefined;
  const target = wizard.target.length > 0 ? wizard.target : wizard.hand;
  return create(TickSchema, { gdpPose: wizard.hand, hcpPose: target });
}
