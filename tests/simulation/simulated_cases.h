// SPDX-License-Identifier: Apache-2.0
// A simulated exoskeleton that stays where it starts, and what it renders.
#pragma once

#include "phalanx/simulation/simulated_exoskeleton.h"
#include "plant_cases.h"

namespace phalanx::test {

/// The joints' friction holds them wherever they start.
inline Exoskeleton held_device() {
  Exoskeleton exo = two_joint_device();
  for (ExoJoint& joint : exo.joints) joint.friction.coulomb = 10.0;
  return exo;
}

inline JointArray posture(double mcp, double pip) {
  JointArray angle{};
  angle[at(kMcp)] = mcp;
  angle[at(kPip)] = pip;
  return angle;
}

/// The torque on the MCP that was rendered at each tick.
inline double rendered_at_next(SimulatedExoskeleton& device) {
  device.begin_tick();
  const double torque = device.rendered().torque[at(kMcp)];
  device.end_tick({});
  return torque;
}

}  // namespace phalanx::test
