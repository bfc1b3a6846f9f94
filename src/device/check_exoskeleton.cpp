// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "phalanx/core/constants.h"
#include "phalanx/device/exoskeleton.h"

namespace phalanx {
namespace {

[[noreturn]] void refuse(const std::string& place, const std::string& problem) {
  throw std::invalid_argument(fmt::format("{}: {}", place, problem));
}

/// Checker for the numbers of one joint or motor.
class Checker {
 public:
  explicit Checker(std::string place) : place_(std::move(place)) {}

  void at_least(std::string_view name, double value, double least) const {
    if (!(value >= least && value < kInfinity))
      refuse(place_, fmt::format("{} = {}: must be finite and >= {}; change the value", name, value, least));
  }
  void above_0(std::string_view name, double value) const {
    if (!(value > 0.0 && value < kInfinity))
      refuse(place_, fmt::format("{} = {}: must be finite and > 0; change the value", name, value));
  }
  void friction(const DryFriction& f) const {
    at_least("friction", f.coulomb, 0.0);
    at_least("static ratio", f.static_ratio, 1.0);
    above_0("Stribeck speed", f.stribeck_speed);
    at_least("capstan", f.capstan, 0.0);
  }

 private:
  std::string place_;
};

std::string joint_place(int joint) { return fmt::format("joint {}", joint_name(joint)); }

void require_index(int joint) {
  if (joint < 0 || joint >= kJoints)
    refuse(fmt::format("joint {}", joint),
           fmt::format("the hand has the joints 0 to {}; name one of them", kJoints - 1));
}

void check_joint(const ExoJoint& joint) {
  const Checker check(joint_place(joint.joint));
  check.above_0("inertia [kg m^2]", joint.inertia);
  check.at_least("damping [N m s/rad]", joint.damping, 0.0);
  check.friction(joint.friction);
  check.at_least("sensor step [rad]", joint.sensor_lsb, 0.0);
  check.at_least("sensor noise [rad]", joint.sensor_noise, 0.0);
}

/// Checks a name. It is part of a key, "motors.NAME.lag_ms", and a number in a key counts elements
/// of an array.
void check_name(const std::string& name) {
  bool good = !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0;
  for (const char c : name)
    good = good && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-');
  if (!good)
    refuse(fmt::format("motor \"{}\"", name),
           "a name begins with a letter, and has letters, digits, _ and - only; rename it");
}

void check_linkages(const ExoMotor& motor, const std::string& place) {
  for (std::size_t i = 0; i < motor.linkages.size(); ++i) {
    const JointLinkage& linkage = motor.linkages[i];
    require_index(linkage.joint);
    const std::string of = fmt::format("{}, linkage of {}", place, joint_name(linkage.joint));
    for (std::size_t other = i + 1; other < motor.linkages.size(); ++other)
      if (motor.linkages[other].joint == linkage.joint) refuse(of, "is there twice; keep one");
    check_linkage(linkage, of);
    const double arm = motor.arm[static_cast<std::size_t>(linkage.joint)];
    if (arm != largest_arm(linkage))
      refuse(of,
             fmt::format("the motor's moment arm is {} m, the linkage's largest {} m; add the linkage with "
                         "add_linkage()",
                         arm, largest_arm(linkage)));
  }
}

void check_motor(const ExoMotor& motor, const std::array<bool, kJoints>& has_joint) {
  check_name(motor.name);
  const std::string place = fmt::format("motor {}", motor.name);
  const Checker check(place);
  bool moves = false;
  for (int j = 0; j < kJoints; ++j) {
    const double arm = motor.arm[static_cast<std::size_t>(j)];
    if (!std::isfinite(arm))
      refuse(place,
             fmt::format("moment arm about {} = {}: must be finite; change the value", joint_name(j), arm));
    if (arm == 0.0) continue;
    moves = true;
    if (!has_joint[static_cast<std::size_t>(j)]) {
      refuse(place, fmt::format("moment arm about {} = {} m: the device has no such joint; add it to the "
                                "joints, or remove the arm",
                                joint_name(j), arm));
    }
  }
  check_linkages(motor, place);
  if (!moves) refuse(place, "moves no joint; give it a moment arm that is not 0, or remove the motor");
  check.at_least("lag [s]", motor.lag, 0.0);
  check.above_0("force limit [N]", motor.force_limit);
  check.at_least("bias [N]", motor.bias, 0.0);
  if (motor.bias > 0.0 && !motor.pull_only)
    refuse(place,
           fmt::format("bias = {} N: belongs to a tendon that only pulls; set pull_only, or remove the bias",
                       motor.bias));
  if (motor.bias > motor.force_limit)
    refuse(place, fmt::format("bias = {} N: is more than the force limit of {} N; lower it", motor.bias,
                              motor.force_limit));
  check.above_0("force constant [N/A]", motor.force_constant);
  check.above_0("mass [kg]", motor.mass);
  check.at_least("damping [N s/m]", motor.damping, 0.0);
  check.above_0("tendon stiffness [N/m]", motor.tendon_stiffness);
  check.at_least("tendon damping [N s/m]", motor.tendon_damping, 0.0);
  check.at_least("backlash [m]", motor.backlash, 0.0);
  check.friction(motor.sheath);
}

/// Checks the joints. @returns true for each joint of the hand that the device has
std::array<bool, kJoints> check_joints(const Exoskeleton& exo) {
  if (exo.joints.empty()) refuse("the device", "has no joint; add one");
  std::array<bool, kJoints> has_joint{};
  for (const ExoJoint& joint : exo.joints) {
    require_index(joint.joint);
    bool& seen = has_joint[static_cast<std::size_t>(joint.joint)];
    if (seen) refuse(joint_place(joint.joint), "is there twice; keep one");
    seen = true;
    check_joint(joint);
  }
  return has_joint;
}

void check_coupled(const Exoskeleton& exo, const std::array<bool, kJoints>& has_joint) {
  std::array<bool, kJoints> taken = has_joint;
  for (const CoupledJoint& coupled : exo.coupled) {
    require_index(coupled.joint);
    require_index(coupled.of);
    const std::string place = fmt::format("coupled {}", joint_place(coupled.joint));
    bool& seen = taken[static_cast<std::size_t>(coupled.joint)];
    if (seen) refuse(place, "is one of the device's own joints, or is coupled twice; keep one");
    seen = true;
    if (!has_joint[static_cast<std::size_t>(coupled.of)])
      refuse(place, fmt::format("follows {}, which the device does not have; name one of the device's joints",
                                joint_name(coupled.of)));
    if (!std::isfinite(coupled.ratio) || !std::isfinite(coupled.offset))
      refuse(place, fmt::format("ratio = {}, offset = {} rad: must be finite; change the value",
                                coupled.ratio, coupled.offset));
  }
}

void check_controller(const Exoskeleton& exo, const std::array<bool, kJoints>& has_joint) {
  const ExoController& controller = exo.controller;
  const Checker check("controller");
  check.above_0("rate [Hz]", controller.rate_hz);
  check.at_least("compute delay [s]", controller.compute_delay, 0.0);
  check.at_least("return delay [s]", controller.return_delay, 0.0);
  const auto sensed = [&](int digit) {
    for (int i = 0; i < kJointsPerDigit; ++i)
      if (has_joint[static_cast<std::size_t>(joint_index(digit, i))]) return true;
    return false;
  };
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitCopy& copy = controller.copy[static_cast<std::size_t>(digit)];
    if (copy.of == -1) continue;
    const std::string place = fmt::format("what the {} copies", digit_name(digit));
    if (copy.of < 0 || copy.of >= kDigits)
      refuse(place, fmt::format("of = {}: is no digit; name one from 0 to {}, or -1 for none", copy.of,
                                kDigits - 1));
    Checker(place).at_least("gain", copy.gain, 0.0);
    if (sensed(digit))
      refuse(place,
             "the device has joints of this digit, it needs no copy; remove the copy, or set its `of` to "
             "\"none\"");
    if (!sensed(copy.of))
      refuse(place, fmt::format("the device has no joint of the {}; copy a digit that it senses",
                                digit_name(copy.of)));
  }
}

}  // namespace

void check_exoskeleton(const Exoskeleton& exo) {
  const std::array<bool, kJoints> has_joint = check_joints(exo);
  check_coupled(exo, has_joint);
  if (exo.motors.size() > static_cast<std::size_t>(kMaxMotors))
    refuse("the device",
           fmt::format("has {} motors; at most {} are supported", exo.motors.size(), kMaxMotors));
  for (std::size_t m = 0; m < exo.motors.size(); ++m) {
    check_motor(exo.motors[m], has_joint);
    for (std::size_t other = 0; other < m; ++other)
      if (exo.motors[other].name == exo.motors[m].name)
        refuse(fmt::format("motor {}", exo.motors[m].name), "is there twice; rename one");
  }
  check_controller(exo, has_joint);
}

}  // namespace phalanx
