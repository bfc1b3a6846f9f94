// SPDX-License-Identifier: Apache-2.0
// What a fingertip feels of the shipped devices along the press: with g = n'J at the fingertip's first
// contact of a scene, joints of impedances Z_j that move independently of each other give  1/Z = sum_j g_j^2
// / Z_j.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "phalanx/hand/hand_model.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/patient_file.h"

namespace phalanx {
namespace {

constexpr int kThumb = 0;
constexpr int kIndex = 1;
constexpr std::size_t kJointCount = kJointsPerDigit;

/// The reference presses (docs/device-file.md). Both are the papers' hand's, which keeps its numbers.
SceneDescription reference_press() { return load_scene("stability_press"); }
SceneDescription reference_grasp() {
  return load_scene("stability_grasp", {{"objects.0.triangles", "4000"}});
}

/// Lever arms of the digit's joints about the press normal [m], where its fingertip first meets the scene's
/// object.
std::optional<std::array<double, kJointCount>> lever_arms(const SceneDescription& scene, int digit) {
  const HapticModel model = build_model(scene);
  const Motion motion = build_motion(scene);
  HapticState state(model, scene.parameters);
  for (int tick = 0; tick < 1000; ++tick) {
    Sample sample;
    sample.time_s = tick / scene.parameters.rate_hz;
    sample.angle = motion.at(sample.time_s);
    static_cast<void>(step(model, scene.parameters, sample, state));
    const Snapshot& snapshot = state.snapshot();
    const SegmentSnapshot& tip = snapshot.segment[static_cast<std::size_t>(segment_index(digit, 2))];
    if (!tip.contact) continue;
    DigitPose pose;
    model.hand.digit_pose(digit, digit_angles(snapshot.gdp_angle, digit), pose);
    const PointJacobian jacobian = point_jacobian(pose, 2, tip.point);
    std::array<double, kJointCount> g{};
    for (std::size_t i = 0; i < kJointCount; ++i) g[i] = tip.normal.dot(jacobian.linear[i]);
    return g;
  }
  return std::nullopt;
}

/// What the fingertip feels, SI.
struct Fingertip {
  double mass, mass_of_links;
  double damping;
  double sheath_friction, joint_friction;
  double tendon_stiffness, tendon_damping, backlash;
  double force_limit;
  double sensor_lsb, sensor_noise;
  double stribeck_sheath, stribeck_joint;
  double patient_stiffness, patient_damping;
};

const ExoMotor& motor_of(const Exoskeleton& exo, int joint) {
  for (const ExoMotor& motor : exo.motors)
    if (motor.arm[static_cast<std::size_t>(joint)] != 0.0) return motor;
  throw std::runtime_error("no motor");
}

const ExoJoint& joint_of(const Exoskeleton& exo, int joint) {
  for (const ExoJoint& own : exo.joints)
    if (own.joint == joint) return own;
  throw std::runtime_error("no joint");
}

Fingertip felt(const Exoskeleton& exo, const PatientParameters& patient, int digit,
               const std::array<double, kJointCount>& g) {
  Fingertip sum{};
  Fingertip least{};
  least.sheath_friction = least.joint_friction = least.force_limit = 1e9;
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const int j = joint_index(digit, i);
    const ExoJoint& joint = joint_of(exo, j);
    const ExoMotor& motor = motor_of(exo, j);
    const double arm = std::abs(motor.arm[static_cast<std::size_t>(j)]);
    const double lever = std::abs(g[static_cast<std::size_t>(i)]);
    const double g2 = lever * lever;
    const double r2 = arm * arm;
    sum.mass += g2 / (joint.inertia + motor.mass * r2);
    sum.mass_of_links += g2 / joint.inertia;
    sum.damping += g2 / (joint.damping + motor.damping * r2);
    sum.tendon_stiffness += g2 / (motor.tendon_stiffness * r2);
    sum.tendon_damping += g2 / (motor.tendon_damping * r2);
    sum.backlash += lever * motor.backlash / arm;
    sum.sensor_lsb += lever * joint.sensor_lsb;
    sum.sensor_noise += g2 * joint.sensor_noise * joint.sensor_noise;
    sum.stribeck_sheath += lever * motor.sheath.stribeck_speed / arm;
    sum.stribeck_joint += lever * joint.friction.stribeck_speed;
    sum.patient_stiffness += g2 / patient.stiffness[static_cast<std::size_t>(j)];
    sum.patient_damping += g2 / patient.damping[static_cast<std::size_t>(j)];
    // A force at the fingertip stands as long as every joint withstands its torque.
    least.sheath_friction = std::min(least.sheath_friction, motor.sheath.coulomb * arm / lever);
    least.joint_friction = std::min(least.joint_friction, joint.friction.coulomb / lever);
    least.force_limit = std::min(least.force_limit, motor.force_limit * arm / lever);
  }
  return {.mass = 1 / sum.mass,
          .mass_of_links = 1 / sum.mass_of_links,
          .damping = 1 / sum.damping,
          .sheath_friction = least.sheath_friction,
          .joint_friction = least.joint_friction,
          .tendon_stiffness = 1 / sum.tendon_stiffness,
          .tendon_damping = 1 / sum.tendon_damping,
          .backlash = sum.backlash,
          .force_limit = least.force_limit,
          .sensor_lsb = sum.sensor_lsb,
          .sensor_noise = std::sqrt(sum.sensor_noise),
          .stribeck_sheath = sum.stribeck_sheath,
          .stribeck_joint = sum.stribeck_joint,
          .patient_stiffness = 1 / sum.patient_stiffness,
          .patient_damping = 1 / sum.patient_damping};
}

#define EXPECT_WITHIN_1_PERCENT(value, expected) EXPECT_NEAR(value, expected, 0.01 * (expected))

void expect_the_pages_fingertip(const SceneDescription& scene, int digit) {
  const auto g = lever_arms(scene, digit);
  ASSERT_TRUE(g.has_value()) << "the fingertip never touches";
  SCOPED_TRACE(testing::PrintToString(*g));
  const Fingertip tip = felt(load_device_file("beihang"), load_patient_file("adult"), digit, *g);
  EXPECT_WITHIN_1_PERCENT(tip.mass, 0.24);
  EXPECT_WITHIN_1_PERCENT(tip.mass_of_links, 0.04);
  EXPECT_WITHIN_1_PERCENT(tip.damping, 1.6);
  EXPECT_WITHIN_1_PERCENT(tip.sheath_friction, 0.34);
  EXPECT_WITHIN_1_PERCENT(tip.joint_friction, 0.06);
  EXPECT_WITHIN_1_PERCENT(tip.tendon_stiffness, 10e3);
  EXPECT_WITHIN_1_PERCENT(tip.tendon_damping, 5.0);
  EXPECT_WITHIN_1_PERCENT(tip.backlash, 0.1e-3);
  EXPECT_WITHIN_1_PERCENT(tip.force_limit, 10.0);
  EXPECT_WITHIN_1_PERCENT(tip.sensor_lsb, 25e-6);
  EXPECT_WITHIN_1_PERCENT(tip.sensor_noise, 10e-6);
  EXPECT_WITHIN_1_PERCENT(tip.stribeck_sheath, 2e-3);
  EXPECT_WITHIN_1_PERCENT(tip.stribeck_joint, 2e-3);
  EXPECT_WITHIN_1_PERCENT(tip.patient_stiffness, 700.0);
  EXPECT_WITHIN_1_PERCENT(tip.patient_damping, 2.8);
}

TEST(DevicePresets, GiveTheIndexFingertipTheStatedMassDampingStiffnessAndFriction) {
  expect_the_pages_fingertip(reference_press(), kIndex);
}

TEST(DevicePresets, GiveTheThumbTheSame) { expect_the_pages_fingertip(reference_grasp(), kThumb); }

TEST(DevicePresets, StateTheControllerAndTheRatiosOnceForAll) {
  const Exoskeleton exo = load_device_file("beihang");
  EXPECT_EQ(exo.controller.rate_hz, 1000.0);
  EXPECT_DOUBLE_EQ(exo.controller.compute_delay, 0.0045);
  EXPECT_DOUBLE_EQ(exo.controller.return_delay, 0.001);
  for (const ExoMotor& motor : exo.motors) {
    EXPECT_DOUBLE_EQ(motor.lag, 0.004);
    EXPECT_EQ(motor.sheath.static_ratio, 1.05);
  }
  for (const ExoJoint& joint : exo.joints) EXPECT_EQ(joint.friction.static_ratio, 1.05);
}

TEST(DevicePresets, DifferFromEachOtherAsTheirDescriptionsSay) {
  const auto g = lever_arms(reference_press(), kIndex);
  ASSERT_TRUE(g.has_value());
  const PatientParameters adult = load_patient_file("adult");
  const Fingertip light = felt(load_device_file("light"), adult, kIndex, *g);
  EXPECT_WITHIN_1_PERCENT(light.mass, 0.04 + 0.05);
  EXPECT_WITHIN_1_PERCENT(light.mass_of_links, 0.04);
  EXPECT_WITHIN_1_PERCENT(light.damping, 0.8 + 0.2);
  EXPECT_WITHIN_1_PERCENT(light.sheath_friction, 0.085);
  EXPECT_WITHIN_1_PERCENT(light.joint_friction, 0.06);
  EXPECT_WITHIN_1_PERCENT(light.tendon_stiffness, 10e3);
  const Fingertip heavy = felt(load_device_file("heavy_viscous"), adult, kIndex, *g);
  EXPECT_WITHIN_1_PERCENT(heavy.mass, 1.2);
  EXPECT_WITHIN_1_PERCENT(heavy.damping, 20.8);
  EXPECT_WITHIN_1_PERCENT(heavy.sheath_friction, 0.051);
  EXPECT_WITHIN_1_PERCENT(heavy.joint_friction, 0.009);
  const Fingertip frictionless = felt(load_device_file("frictionless"), adult, kIndex, *g);
  EXPECT_WITHIN_1_PERCENT(frictionless.mass, 0.24);
  EXPECT_EQ(frictionless.sheath_friction, 0.0);
  EXPECT_EQ(frictionless.joint_friction, 0.0);
}

}  // namespace
}  // namespace phalanx
