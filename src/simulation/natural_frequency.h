// SPDX-License-Identifier: Apache-2.0
// Bound of an exoskeleton's natural frequencies, which limits the step of an integration.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/simulation/patient.h"

namespace phalanx {

/// Bound of the natural frequencies, and the spring and the joint that decide it.
struct FastestFrequency {
  double square = 0.0;  ///< [rad^2/s^2]
  int motor = -1;       ///< whose tendon is the spring; -1: the patient's spring of `joint`
  int joint = -1;       ///< the one that the spring accelerates most; -1: there is no spring
};

/// @returns an upper bound of the fastest natural frequency. It is exact if no spring shares a body with
/// another. Spring i with stiffness k_i stretches by v_i . x. With masses M, the squares of the frequencies
/// are the eigenvalues of  G_ij = sqrt(k_i k_j) v_i' M^-1 v_j  (and zeros). No eigenvalue exceeds the largest
/// sum of a row's absolute values (Gershgorin).
[[nodiscard]] inline FastestFrequency fastest_frequency(const Exoskeleton& exoskeleton,
                                                        const PatientParameters& patient) {
  std::array<double, kJoints> compliance{};  // 1 / inertia, 0 where the device has no joint
  for (const ExoJoint& joint : exoskeleton.joints)
    compliance[static_cast<std::size_t>(joint.joint)] = 1.0 / joint.inertia;
  std::vector<JointArray> springs;  // sqrt(k) v, the part of the joints
  std::vector<double> own;          // k v' M^-1 v, the part of the rotor
  for (const ExoMotor& motor : exoskeleton.motors) {
    springs.push_back(motor.arm);
    for (double& arm : springs.back()) arm *= std::sqrt(motor.tendon_stiffness);
    own.push_back(motor.tendon_stiffness / motor.mass);
  }
  for (const ExoJoint& joint : exoskeleton.joints) {
    const auto j = static_cast<std::size_t>(joint.joint);
    springs.push_back({});
    springs.back()[j] = std::sqrt(patient.stiffness[j]);
    own.push_back(0.0);
  }
  FastestFrequency fastest;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    double row = own[i];
    for (const JointArray& other : springs) {
      double product = 0.0;
      for (std::size_t j = 0; j < compliance.size(); ++j) product += springs[i][j] * other[j] * compliance[j];
      row += std::abs(product);
    }
    if (!(row > fastest.square)) continue;
    fastest = {.square = row, .motor = i < exoskeleton.motors.size() ? static_cast<int>(i) : -1, .joint = 0};
    const auto share = [&](int joint) {
      return springs[i][idx(joint)] * springs[i][idx(joint)] * compliance[idx(joint)];
    };
    for (int joint = 1; joint < kJoints; ++joint)
      if (share(joint) > share(fastest.joint)) fastest.joint = joint;
  }
  return fastest;
}

}  // namespace phalanx
