// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/core/constants.h"

namespace phalanx {

/// Angle beyond the hand's range of motion, on either side, that a simulated sensor still measures [rad].
inline constexpr double kShownBeyondRange = 20.0 * kPi / 180.0;

}  // namespace phalanx
