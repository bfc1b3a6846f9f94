// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/scene/hand_meshes.h"

namespace phalanx {

/// Describes a hand in text: its sizes with their distance from the published means in standard deviations,
/// its ranges of motion, its triangles.
[[nodiscard]] std::string hand_table(const LoadedHand& hand);

}  // namespace phalanx
