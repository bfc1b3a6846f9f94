// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "phalanx/force/stabiliser.h"

namespace phalanx::test {

inline constexpr std::array<Stabiliser, 10> kAllStabilisers = {Stabiliser::kNone,
                                                               Stabiliser::kSmoothing,
                                                               Stabiliser::kRiseOnly,
                                                               Stabiliser::kDirection,
                                                               Stabiliser::kLowPass,
                                                               Stabiliser::kKelvinVoigt,
                                                               Stabiliser::kVirtualCoupling,
                                                               Stabiliser::kPassivity,
                                                               Stabiliser::kEnergyBounding,
                                                               Stabiliser::kLocalWall};

}  // namespace phalanx::test
