// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/core/constants.h"

namespace phalanx {

/// So far beyond the hand's range of motion, on either side, a simulated angle sensor still shows the angle
/// [rad].
inline constexpr double kShownBeyondRange = 20.0 * kPi / 180.0;

}  // namespace phalanx
