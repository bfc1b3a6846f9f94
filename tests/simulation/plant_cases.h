// SPDX-License-Identifier: Apache-2.0
// Small devices and inputs for tests of the plant.
#pragma once

#include <cstddef>
#include <string>

#include "device/two_joint_device.h"
#include "phalanx/simulation/plant.h"

namespace phalanx::test {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// One joint and no motor: a mass with viscous friction.
inline Exoskeleton bare_joint(double inertia, double damping) {
  Exoskeleton exo;
  exo.name = "bare joint";
  exo.joints = {joint_of(kMcp)};
  exo.joints[0].inertia = inertia;
  exo.joints[0].damping = damping;
  return exo;
}

/// One joint with one motor.
inline Exoskeleton one_motor(double arm) {
  Exoskeleton exo = bare_joint(1e-4, 1e-3);
  exo.motors = {motor_on("mcp", kMcp, arm)};
  return exo;
}

inline PatientParameters no_patient() {
  PatientParameters patient;
  patient.name = "nobody";
  return patient;
}

inline PlantInput no_input(const Exoskeleton& exo) {
  PlantInput input;
  input.motor_force.assign(exo.motors.size(), 0.0);
  return input;
}

}  // namespace phalanx::test
