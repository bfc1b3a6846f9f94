// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/force_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phalanx {

double law_force(const ForceLawParameters& law, double depth, double speed) noexcept {
  if (!(depth > 0.0)) return 0.0;
  const double hooke = law.stiffness * depth;
  switch (law.law) {
    case ForceLaw::kHooke:
      return hooke;
    case ForceLaw::kKelvinVoigt:
      return std::max(0.0, hooke + law.damping * speed);
    case ForceLaw::kHuntCrossley: {
      constexpr double kReferenceDepth = 1e-3;
      const double spring =
          law.stiffness * kReferenceDepth * std::pow(depth / kReferenceDepth, law.hunt_crossley_exponent);
      return std::max(0.0, spring * (1.0 + law.hunt_crossley_damping * speed));
    }
    case ForceLaw::kDuffing:
      return hooke + law.cubic * depth * depth * depth;
    case ForceLaw::kLinearThenCubic: {
      const double beyond = std::max(0.0, depth - law.linear_depth);
      return hooke + law.cubic * beyond * beyond * beyond;
    }
  }
  return 0.0;
}

double lowpass_gain(double corner_hz, double period) noexcept {
  return 1.0 - std::exp(-2.0 * std::numbers::pi * corner_hz * period);
}

}  // namespace phalanx
