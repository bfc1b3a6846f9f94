// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/force/haptic_parameters.h"

namespace phalanx {

/// Checks that the parameters of a model are in their ranges. Set-up only.
/// @throws std::invalid_argument naming the parameter, its value and its range, if one is outside. An
/// integrator who fills HapticParameters by hand gets the same protection as a scene file.
void check_parameters(const HapticParameters& parameters);

}  // namespace phalanx
