// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// @throws std::invalid_argument naming the parameter, its value and its range, if one is outside. An
/// integrator who fills a HapticModel by hand gets the same protection as a scene file.
void check_parameters(const HapticModel& model);

}  // namespace phalanx
