// SPDX-License-Identifier: Apache-2.0
#include "step/check_parameters.h"

#include <stdexcept>
#include <string>

#include "phalanx/core/constants.h"
#include "phalanx/force/parameter_ranges.h"

namespace phalanx {
namespace {

void check(const std::string& name, double value, const NumberRange& range) {
  if (range.contains(value)) return;
  throw std::invalid_argument(name + " = " + shortest_text(value) + ": must be " + range.text());
}

/// Checks that the value is one of the enumeration, whose last value is `last`.
template <class Enum>
void check_choice(const char* name, Enum value, Enum last) {
  check(name, static_cast<double>(value), between(0, static_cast<double>(last)));
}

/// Checks that a law or a method of the caller has its function.
void check_own(const char* name, bool chosen, bool given) {
  if (chosen && !given)
    throw std::invalid_argument(std::string(name) + " = null: kOwn needs a function; give one");
}

void check_law(const ForceLawParameters& law) {
  check_choice("force.law", law.law, ForceLaw::kOwn);
  check_own("force.own.function", law.law == ForceLaw::kOwn, law.own.function != nullptr);
  check("force.stiffness [N/m]", law.stiffness, ranges::kStiffness);
  check("force.damping [N s/m]", law.damping, ranges::kDamping);
  check("force.velocity_lowpass_hz", law.velocity_lowpass_hz, ranges::kLowpass);
  check("force.hunt_crossley_exponent", law.hunt_crossley_exponent, ranges::kHuntCrossleyExponent);
  check("force.hunt_crossley_damping [s/m]", law.hunt_crossley_damping, ranges::kHuntCrossleyDamping);
  check("force.cubic [N/m^3]", law.cubic, ranges::kCubic);
  check("force.linear_depth [m]", law.linear_depth, ranges::kLinearDepth);
}

void check_stabiliser(const StabiliserParameters& stabiliser) {
  check_choice("stabiliser.method", stabiliser.method, Stabiliser::kOwn);
  check_own("stabiliser.own.function", stabiliser.method == Stabiliser::kOwn,
            stabiliser.own.function != nullptr);
  check("stabiliser.min_rate [N/s]", stabiliser.min_rate, ranges::kMinRate);
  check("stabiliser.max_rate [N/s]", stabiliser.max_rate, ranges::kMaxRate);
  check("stabiliser.lowpass_hz", stabiliser.lowpass_hz, ranges::kLowpass);
  check("stabiliser.damping [N s/m]", stabiliser.damping, ranges::kDamping);
  check("stabiliser.turn_rate [rad/s]", stabiliser.turn_rate, ranges::kTurnRate);
  check("stabiliser.coupling_stiffness [N/m]", stabiliser.coupling_stiffness, ranges::kCouplingStiffness);
  check("stabiliser.coupling_damping [N s/m]", stabiliser.coupling_damping, ranges::kDamping);
  check("stabiliser.passivity_damping_max [N s/m]", stabiliser.passivity_damping_max, ranges::kDamping);
  check("stabiliser.device_damping [N s/m]", stabiliser.device_damping, ranges::kDamping);
  check("stabiliser.wall_valid [s]", stabiliser.wall_valid, ranges::kWallValid);
}

/// Checks the limits that are on.
void check_limits(const LimitParameters& limits) {
  if (limits.fingertip_force_enabled)
    check("limits.fingertip_force [N]", limits.fingertip_force, ranges::kFingertipForce);
  if (limits.joint_torque_enabled)
    check("limits.joint_torque [Nm]", limits.joint_torque, ranges::kJointTorque);
  if (limits.torque_rate_enabled) check("limits.torque_rate [Nm/s]", limits.torque_rate, ranges::kTorqueRate);
  if (limits.joint_speed != kInfinity)
    check("limits.joint_speed [rad/s]", limits.joint_speed, ranges::kJointSpeed);
}

}  // namespace

void check_parameters(const HapticParameters& parameters) {
  check("rate_hz", parameters.rate_hz, ranges::kRate);
  check("contact.margin [m]", parameters.contact.margin, ranges::kMargin);
  check("contact.slid_distance [m]", parameters.contact.slid_distance, ranges::kSlidDistance);
  check_choice("contact.mode", parameters.contact.mode, ContactMode::kSliding);
  check("contact.friction", parameters.contact.friction, ranges::kFriction);
  check("contact.tangential_stiffness_ratio", parameters.contact.tangential_stiffness_ratio,
        ranges::kTangentialStiffnessRatio);
  check("contact.spin_radius [m]", parameters.contact.spin_radius, ranges::kSpinRadius);
  check("contact.max_contacts", parameters.contact.max_contacts, ranges::kMaxContacts);
  check_law(parameters.force);
  check_stabiliser(parameters.stabiliser);
  check_choice("oscillation.reaction", parameters.oscillation.reaction, OscillationReaction::kHalve);
  check("oscillation.swing [N]", parameters.oscillation.swing, ranges::kSwing);
  check_limits(parameters.limits);
}

}  // namespace phalanx
