// SPDX-License-Identifier: Apache-2.0
// Keys of a scene that stories look at.
import type { State } from "../../../src/gen/phalanx/cockpit_pb";

export const stiffnessKey = "force.stiffness_n_per_mm";

/// What is in force for a key, as it would stand in a scene file; undefined: not stated.
export const valueOf = (state: State, key: string): string | undefined => state.value.find((one) => one.key === key)?.value;
