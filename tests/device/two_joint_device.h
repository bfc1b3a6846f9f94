// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <numbers>
#include <string>

#include "phalanx/device/exoskeleton.h"

namespace phalanx::test {

inline constexpr int kMcp = 4;  ///< joint of two_joint_device(): flexion of the index finger
inline constexpr int kPip = 6;

inline ExoMotor motor_on(const std::string& name, int joint, double arm) {
  ExoMotor motor;
  motor.name = name;
  motor.arm[static_cast<std::size_t>(joint)] = arm;
  motor.force_limit = 10.0;
  motor.mass = 0.2;
  motor.tendon_stiffness = 1e4;
  return motor;
}

inline ExoJoint joint_of(int joint) {
  ExoJoint exo;
  exo.joint = joint;
  exo.inertia = 1e-4;
  return exo;
}

/// The four-bar linkage of assets/devices/linkages.toml, on a joint of the caller's.
inline JointLinkage four_bar_linkage(int joint) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  return {.joint = joint,
          .min_angle = -5.0 * kDegree,
          .max_angle = 105.0 * kDegree,
          .four_bar = FourBar{.ground = 0.028,
                              .crank = 0.018,
                              .coupler = 0.032,
                              .rocker = 0.014,
                              .rocker_angle = 40.0 * kDegree,
                              .crossed = false,
                              .drum = -0.014}};
}

/// The index finger's MCP and PIP flexion, a motor each; the DIP follows the PIP at half its angle.
inline Exoskeleton two_joint_device() {
  Exoskeleton exo;
  exo.name = "two joints";
  exo.joints = {joint_of(4), joint_of(6)};
  exo.coupled = {{.joint = 7, .of = 6, .ratio = 0.5, .offset = 0.1}};
  exo.motors = {motor_on("mcp", 4, -0.0125), motor_on("pip", 6, -0.01)};
  return exo;
}

}  // namespace phalanx::test
