// SPDX-License-Identifier: Apache-2.0
// Devices and patients as canonical text, for fingerprints.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "phalanx/scene/device_file.h"
#include "phalanx/scene/patient_file.h"

namespace phalanx {
namespace {

void line(std::string& text, const std::string& key, double value) {
  text += fmt::format("{} {:.17g}\n", key, value);
}

void lines(std::string& text, const std::string& key, const DryFriction& friction) {
  line(text, key + ".coulomb", friction.coulomb);
  line(text, key + ".static_ratio", friction.static_ratio);
  line(text, key + ".stribeck_speed", friction.stribeck_speed);
  line(text, key + ".capstan", friction.capstan);
}

void lines(std::string& text, const ExoJoint& joint) {
  const std::string key = fmt::format("joints.{}", joint_name(joint.joint));
  line(text, key + ".inertia", joint.inertia);
  line(text, key + ".damping", joint.damping);
  lines(text, key + ".friction", joint.friction);
  line(text, key + ".sensor_lsb", joint.sensor_lsb);
  line(text, key + ".sensor_noise", joint.sensor_noise);
  line(text, key + ".torque_sensor", joint.torque_sensor ? 1.0 : 0.0);
}

void lines(std::string& text, const ExoMotor& motor) {
  const std::string key = fmt::format("motors.{}", motor.name);
  int joint = 0;
  for (const double arm : motor.arm) {
    if (arm != 0.0) line(text, fmt::format("{}.arm.{}", key, joint_name(joint)), arm);
    ++joint;
  }
  for (const JointLinkage& linkage : motor.linkages) {
    const std::string of = fmt::format("{}.linkage.{}", key, joint_name(linkage.joint));
    line(text, of + ".min_angle", linkage.min_angle);
    line(text, of + ".max_angle", linkage.max_angle);
    for (std::size_t k = 0; k < linkage.polynomial.size(); ++k)
      line(text, fmt::format("{}.polynomial.{}", of, k), linkage.polynomial[k]);
    for (std::size_t i = 0; i < linkage.table.size(); ++i) {
      line(text, fmt::format("{}.table.{}.angle", of, i), linkage.table[i].angle);
      line(text, fmt::format("{}.table.{}.arm", of, i), linkage.table[i].arm);
    }
    if (!linkage.four_bar) continue;
    line(text, of + ".four_bar.ground", linkage.four_bar->ground);
    line(text, of + ".four_bar.crank", linkage.four_bar->crank);
    line(text, of + ".four_bar.coupler", linkage.four_bar->coupler);
    line(text, of + ".four_bar.rocker", linkage.four_bar->rocker);
    line(text, of + ".four_bar.rocker_angle", linkage.four_bar->rocker_angle);
    line(text, of + ".four_bar.crossed", linkage.four_bar->crossed ? 1.0 : 0.0);
    line(text, of + ".four_bar.drum", linkage.four_bar->drum);
  }
  line(text, key + ".lag", motor.lag);
  line(text, key + ".force_limit", motor.force_limit);
  line(text, key + ".pull_only", motor.pull_only ? 1.0 : 0.0);
  line(text, key + ".bias", motor.bias);
  line(text, key + ".force_constant", motor.force_constant);
  line(text, key + ".mass", motor.mass);
  line(text, key + ".damping", motor.damping);
  line(text, key + ".tendon_stiffness", motor.tendon_stiffness);
  line(text, key + ".tendon_damping", motor.tendon_damping);
  line(text, key + ".backlash", motor.backlash);
  lines(text, key + ".sheath", motor.sheath);
}

void lines(std::string& text, const ExoController& controller) {
  line(text, "controller.rate_hz", controller.rate_hz);
  line(text, "controller.compute_delay", controller.compute_delay);
  line(text, "controller.return_delay", controller.return_delay);
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitCopy& copy = controller.copy[static_cast<std::size_t>(digit)];
    line(text, fmt::format("copy.{}.of", digit_name(digit)), copy.of);
    line(text, fmt::format("copy.{}.gain", digit_name(digit)), copy.gain);
  }
}

/// Sorts by a key, independent of the device's order.
template <typename Item, typename Key>
std::vector<const Item*> sorted_by(const std::vector<Item>& items, Key key) {
  std::vector<const Item*> sorted;
  for (const Item& item : items) sorted.push_back(&item);
  std::sort(sorted.begin(), sorted.end(), [&](const Item* a, const Item* b) { return key(*a) < key(*b); });
  return sorted;
}

}  // namespace

std::string device_text(const Exoskeleton& exo) {
  std::string text;
  for (const ExoJoint* joint : sorted_by(exo.joints, [](const ExoJoint& j) { return j.joint; }))
    lines(text, *joint);
  for (const CoupledJoint* joint : sorted_by(exo.coupled, [](const CoupledJoint& j) { return j.joint; })) {
    const std::string key = fmt::format("coupled.{}", joint_name(joint->joint));
    text += fmt::format("{}.of {}\n", key, joint_name(joint->of));
    line(text, key + ".ratio", joint->ratio);
    line(text, key + ".offset", joint->offset);
  }
  for (const ExoMotor* motor :
       sorted_by(exo.motors, [](const ExoMotor& m) { return std::string_view(m.name); }))
    lines(text, *motor);
  lines(text, exo.controller);
  return text;
}

std::string patient_text(const PatientParameters& patient) {
  std::string text;
  for (int j = 0; j < kJoints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    line(text, fmt::format("joints.{}.stiffness", joint_name(j)), patient.stiffness[i]);
    line(text, fmt::format("joints.{}.damping", joint_name(j)), patient.damping[i]);
  }
  line(text, "press", patient.press);
  line(text, "press_spread", patient.press_spread);
  line(text, "approach_min", patient.approach_min);
  line(text, "approach_max", patient.approach_max);
  line(text, "tremor", patient.tremor);
  line(text, "tremor_min_hz", patient.tremor_min_hz);
  line(text, "tremor_max_hz", patient.tremor_max_hz);
  line(text, "bump", patient.bump);
  line(text, "bump_start", patient.bump_start);
  line(text, "bump_duration", patient.bump_duration);
  return text;
}

std::string device_text(const SceneDescription& scene) { return device_text(load_device(scene)); }
std::string patient_text(const SceneDescription& scene) { return patient_text(load_patient(scene)); }

}  // namespace phalanx
