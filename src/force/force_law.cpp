// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/force_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace phalanx {
namespace {

constexpr double kReferenceDepth = 1e-3;  // depth at which Hunt-Crossley's stiffness is defined [m]
constexpr double kOwnStep = 1e-6;         // difference of depths for the slope of a caller's law [m]

/// Returns the force of the caller's law, not below 0; NaN without a function. It may be not finite.
double own_force(const OwnForceLaw& own, double depth, double speed) noexcept {
  if (own.function == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const double force = own.function(own.user, depth, speed);
  return force < 0.0 ? 0.0 : force;
}

}  // namespace

double law_force(const ForceLawParameters& law, double depth, double speed) noexcept {
  if (!(depth > 0.0)) return 0.0;
  const double hooke = law.stiffness * depth;
  switch (law.law) {
    case ForceLaw::kHooke:
      return hooke;
    case ForceLaw::kKelvinVoigt:
      return std::max(0.0, hooke + law.damping * speed);
    case ForceLaw::kHuntCrossley: {
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
    case ForceLaw::kOwn:
      return own_force(law.own, depth, speed);
  }
  return 0.0;
}

double law_slope(const ForceLawParameters& law, double depth) noexcept {
  const double d = std::max(0.0, depth);
  switch (law.law) {
    case ForceLaw::kHooke:
    case ForceLaw::kKelvinVoigt:
      return law.stiffness;
    case ForceLaw::kHuntCrossley:
      return law.stiffness * law.hunt_crossley_exponent *
             std::pow(d / kReferenceDepth, law.hunt_crossley_exponent - 1.0);
    case ForceLaw::kDuffing:
      return law.stiffness + 3.0 * law.cubic * d * d;
    case ForceLaw::kLinearThenCubic: {
      const double beyond = std::max(0.0, d - law.linear_depth);
      return law.stiffness + 3.0 * law.cubic * beyond * beyond;
    }
    case ForceLaw::kOwn: {
      const double slope = (law_force(law, d + kOwnStep, 0.0) - law_force(law, d, 0.0)) / kOwnStep;
      return std::isfinite(slope) ? std::max(0.0, slope) : 0.0;
    }
  }
  return 0.0;
}

double lowpass_gain(double corner_hz, double period) noexcept {
  return 1.0 - std::exp(-2.0 * std::numbers::pi * corner_hz * period);
}

}  // namespace phalanx
