// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/stabiliser.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "phalanx/core/constants.h"
#include "phalanx/force/stabiliser_methods.h"

namespace phalanx {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

double method_force(const StabiliserParameters& p, const StabiliserInput& in, double moved,
                    StabiliserMemory& memory) noexcept {
  switch (p.method) {
    case Stabiliser::kSmoothing:
      return smoothed_force(in.force, in.sent, p.min_rate, p.max_rate, in.period);
    case Stabiliser::kRiseOnly:
      return smoothed_force(in.force, in.sent, -kInfinity, p.max_rate, in.period);
    case Stabiliser::kLowPass:
      return low_passed_force(in.force, in.sent, p.lowpass_hz, in.period);
    case Stabiliser::kKelvinVoigt:
      return in.depth > 0.0 ? damped_force(in.force, p.damping, in.speed) : 0.0;
    case Stabiliser::kVirtualCoupling:
      return coupled_force(in.force, in.depth, moved, p.coupling_stiffness, p.coupling_damping, in.period,
                           memory.proxy);
    case Stabiliser::kPassivity: {
      const double force =
          passive_force(in.force, in.sent, in.speed_now, p.passivity_damping_max, in.period, memory.energy);
      return in.depth > 0.0 ? force : 0.0;
    }
    case Stabiliser::kEnergyBounding:
      return in.depth > 0.0 ? energy_bounded_force(in.force, in.sent, moved, p.device_damping, in.period)
                            : 0.0;
    case Stabiliser::kOwn:
      return p.own.function == nullptr ? kNotANumber : p.own.function(p.own.user, in, memory);
    case Stabiliser::kNone:
    case Stabiliser::kDirection:
    case Stabiliser::kLocalWall:
      return in.force;
  }
  return in.force;
}

bool decays_without_contact(Stabiliser method) noexcept {
  return method == Stabiliser::kSmoothing || method == Stabiliser::kRiseOnly ||
         method == Stabiliser::kLowPass;
}

double finite(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

}  // namespace

double stabilised_force(const StabiliserParameters& parameters, const StabiliserInput& input,
                        StabiliserMemory& memory, Status* status) noexcept {
  if (!input.pressing) memory = {};
  if (!input.pressing && !decays_without_contact(parameters.method)) return 0.0;
  StabiliserInput in = input;
  in.force = std::max(0.0, finite(input.force));
  in.sent = std::max(0.0, finite(input.sent));
  in.depth = finite(input.depth);
  in.speed = finite(input.speed);
  in.speed_now = finite(input.speed_now);
  // In the step of arrival the finger was outside for a part of it.
  const double moved = memory.touching ? in.speed_now * in.period : std::max(0.0, in.depth);
  memory.touching = in.pressing && in.depth > 0.0;
  const double force = method_force(parameters, in, moved, memory);
  if (std::isfinite(force)) return parameters.method == Stabiliser::kOwn ? std::max(0.0, force) : force;
  if (status != nullptr) *status |= Status::kCommandNotFinite;
  memory = {};
  return 0.0;
}

}  // namespace phalanx
