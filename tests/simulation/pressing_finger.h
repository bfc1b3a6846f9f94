// SPDX-License-Identifier: Apache-2.0
// Small presses whose numbers can be worked out on paper, for tests of the closed loop.
#pragma once

#include "device/two_joint_device.h"
#include "phalanx/core/index.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/simulation/press_plan.h"
#include "support/simple_hand.h"

namespace phalanx::test {

inline constexpr int kAbduction = 5;  ///< a joint that two_joint_device() does not have
inline constexpr int kDip = 7;
inline constexpr int kTip = 5;  ///< distal segment of the index finger

/// A slab whose top is 20 mm below the straight index finger, no limits, no smoothing, 1 N/mm.
inline Setup finger_above_slab() {
  Setup model(simple_hand(), ObjectModel(moved(make_box(Vec3(0.06, 0.02, 0.3), 12), at(0.0, -0.030, 0.0))));
  turn_limits_off(model);
  model.parameters.force.stiffness = 1000.0;
  return model;
}

/// MCP and PIP flex to these angles in a second; the DIP goes with the PIP as two_joint_device() couples it.
inline Motion flexion(double mcp, double pip) {
  Motion motion;
  motion.time_s = {0.0, 1.0};
  motion.angle = {JointArray{}, JointArray{}};
  motion.angle[1][idx(kMcp)] = mcp;
  motion.angle[1][idx(kPip)] = pip;
  motion.angle[1][idx(kDip)] = 0.5 * pip;
  return motion;
}

/// Springs of 10 Nm/rad on the MCP and 4 Nm/rad on the PIP; presses with 3 N at 50 mm/s, no tremor, no
/// spread, a bump of 2 N.
inline PatientParameters steady_patient() {
  PatientParameters patient;
  patient.name = "steady";
  patient.stiffness[idx(kMcp)] = 10.0;
  patient.stiffness[idx(kPip)] = 4.0;
  patient.press = 3.0;
  patient.press_spread = 0.0;
  patient.approach_min = patient.approach_max = 0.05;
  patient.tremor = 0.0;
  patient.bump = 2.0;
  return patient;
}

/// The index finger's tip at the origin on a wall that looks to +Z, g = (-0.05, -0.02) m on MCP and PIP, the
/// springs of steady_patient(): g'Cg = 0.0025 / 10 + 0.0004 / 4 = 3.5e-4 m/N, 1/(g'Cg) = 20,000 / 7 N/m.
inline PressPlan plan_on_paper() {
  DigitPress press;
  press.segment = kTip;
  press.normal = Vec3::UnitZ();
  press.g[idx(kMcp)] = -0.05;
  press.g[idx(kPip)] = -0.02;
  press.contact[idx(kMcp)] = 0.6;
  press.contact[idx(kPip)] = 0.4;
  press.into[idx(kMcp)] = 0.05 / 10.0 / 3.5e-4;
  press.into[idx(kPip)] = 0.02 / 4.0 / 3.5e-4;
  press.stiffness = 1.0 / 3.5e-4;
  PressPlan plan;
  plan.digit[kIndex] = press;
  plan.open.fill(0.1);
  return plan;
}

}  // namespace phalanx::test
