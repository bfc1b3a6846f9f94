// SPDX-License-Identifier: Apache-2.0
#include "station/parameter_ramp.h"

#include <algorithm>
#include <cmath>

namespace phalanx {
namespace {

/// A bound below this counts as this, so that the ratio of two is finite [N/s].
constexpr double kNothing = 1e-9;

double line(double from, double to, double part) noexcept { return from + part * (to - from); }

/// @returns a value between the two, in equal ratios; an infinite or unbounded end counts as kUnbounded.
double ratio(double from, double to, double part) noexcept {
  const double a = std::clamp(std::abs(from), kNothing, ParameterRamp::kUnbounded);
  const double b = std::clamp(std::abs(to), kNothing, ParameterRamp::kUnbounded);
  return a * std::pow(b / a, part);
}

bool goes_over(Stabiliser method) noexcept {
  return method == Stabiliser::kNone || method == Stabiliser::kSmoothing || method == Stabiliser::kRiseOnly;
}

/// Sets the bounds that the method does not have to kUnbounded.
void unbind(StabiliserParameters& stabiliser) noexcept {
  if (stabiliser.method == Stabiliser::kNone) stabiliser.max_rate = ParameterRamp::kUnbounded;
  if (stabiliser.method != Stabiliser::kSmoothing) stabiliser.min_rate = -ParameterRamp::kUnbounded;
}

}  // namespace

bool goes_over_in_contact(Stabiliser from, Stabiliser to) noexcept {
  return from == to || (goes_over(from) && goes_over(to));
}

void ParameterRamp::go_to(const HapticParameters& target) noexcept {
  from_ = now_;
  to_ = now_;
  to_.force.stiffness = target.force.stiffness;
  to_.force.damping = target.force.damping;
  to_.stabiliser.min_rate = target.stabiliser.min_rate;
  to_.stabiliser.max_rate = target.stabiliser.max_rate;
  if (goes_over_in_contact(now_.stabiliser.method, target.stabiliser.method))
    to_.stabiliser.method = target.stabiliser.method;
  way_ = to_.stabiliser;
  if (from_.stabiliser.method != way_.method) {
    const bool falls =
        from_.stabiliser.method == Stabiliser::kSmoothing || way_.method == Stabiliser::kSmoothing;
    unbind(from_.stabiliser);
    unbind(way_);
    way_.method = falls ? Stabiliser::kSmoothing : Stabiliser::kRiseOnly;
  }
  left_ = kSeconds;
}

void ParameterRamp::advance() noexcept {
  if (left_ <= 0.0) return;
  left_ -= now_.period();
  if (left_ <= 0.0) {
    now_ = to_;
    return;
  }
  const double part = std::clamp(1.0 - left_ / kSeconds, 0.0, 1.0);
  now_.force.stiffness = line(from_.force.stiffness, to_.force.stiffness, part);
  now_.force.damping = line(from_.force.damping, to_.force.damping, part);
  now_.stabiliser.method = way_.method;
  now_.stabiliser.min_rate = -ratio(from_.stabiliser.min_rate, way_.min_rate, part);
  now_.stabiliser.max_rate = ratio(from_.stabiliser.max_rate, way_.max_rate, part);
}

}  // namespace phalanx
