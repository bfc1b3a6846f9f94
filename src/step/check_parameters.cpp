// SPDX-License-Identifier: Apache-2.0
#include "step/check_parameters.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "phalanx/core/constants.h"

namespace phalanx {
namespace {

constexpr double kAny = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::min();

void within(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;  // false for NaN
  throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) + " is outside " +
                              std::to_string(low) + " .. " +
                              (high == kAny ? "any finite number" : std::to_string(high)));
}

}  // namespace

void check_parameters(const HapticParameters& parameters) {
  within("rate_hz", parameters.rate_hz, 1.0, 4000.0);
  within("contact.margin [m]", parameters.contact.margin, 1e-6, 1e-3);
  within("contact.slid_distance [m]", parameters.contact.slid_distance, 0.0, kAny);
  const ForceLawParameters& law = parameters.force;
  within("force.law", static_cast<double>(law.law), 0.0, static_cast<double>(ForceLaw::kLinearThenCubic));
  within("force.stiffness [N/m]", law.stiffness, 0.0, 1e6);
  within("force.damping [N s/m]", law.damping, 0.0, 1e6);
  within("force.velocity_lowpass_hz", law.velocity_lowpass_hz, 1e-3, 1e6);
  within("force.hunt_crossley_exponent", law.hunt_crossley_exponent, 1.0, 5.0);
  within("force.hunt_crossley_damping [s/m]", law.hunt_crossley_damping, 0.0, 1e3);
  within("force.cubic [N/m^3]", law.cubic, 0.0, 1e15);
  within("force.linear_depth [m]", law.linear_depth, 0.0, 1.0);
  const StabiliserParameters& stabiliser = parameters.stabiliser;
  const double method = static_cast<double>(stabiliser.method);
  within("stabiliser.method", method, 0.0, static_cast<double>(Stabiliser::kLocalWall));
  within("-stabiliser.min_rate [N/s]", -stabiliser.min_rate, kTiny, kInfinity);
  within("stabiliser.max_rate [N/s]", stabiliser.max_rate, kTiny, kInfinity);
  within("stabiliser.lowpass_hz", stabiliser.lowpass_hz, 1e-3, 1e6);
  within("stabiliser.damping [N s/m]", stabiliser.damping, 0.0, 1e6);
  within("stabiliser.turn_rate [rad/s]", stabiliser.turn_rate, kTiny, 1e6);
  within("stabiliser.coupling_stiffness [N/m]", stabiliser.coupling_stiffness, 1e-3, 1e9);
  within("stabiliser.coupling_damping [N s/m]", stabiliser.coupling_damping, 0.0, 1e6);
  within("stabiliser.passivity_damping_max [N s/m]", stabiliser.passivity_damping_max, 0.0, 1e6);
  within("stabiliser.device_damping [N s/m]", stabiliser.device_damping, 0.0, 1e6);
  within("stabiliser.wall_valid [s]", stabiliser.wall_valid, kTiny, 1.0);
  const double reaction = static_cast<double>(parameters.oscillation.reaction);
  within("oscillation.reaction", reaction, 0.0, static_cast<double>(OscillationReaction::kHalve));
  within("oscillation.swing [N]", parameters.oscillation.swing, 1e-3, 1e3);
  const LimitParameters& limits = parameters.limits;
  if (limits.fingertip_force_enabled)
    within("limits.fingertip_force [N]", limits.fingertip_force, kTiny, 15.0);
  if (limits.joint_torque_enabled) within("limits.joint_torque [Nm]", limits.joint_torque, kTiny, 5.0);
  if (limits.torque_rate_enabled) within("limits.torque_rate [Nm/s]", limits.torque_rate, kTiny, 1e4);
  if (limits.joint_speed != kInfinity)  // off
    within("limits.joint_speed [rad/s]", limits.joint_speed, kTiny, 1e4);
}

}  // namespace phalanx
