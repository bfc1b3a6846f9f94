// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/press_plan.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/patient_file.h"
#include "simulation/pressing_finger.h"

namespace phalanx {
namespace {

using test::kDip;
using test::kIndex;
using test::kMcp;
using test::kPip;

/// What a plan was made from, and the plan.
struct Planned {
  Planned(test::Setup the_model, const Motion& motion, Exoskeleton the_device, PatientParameters the_patient)
      : model(std::move(the_model)),
        device(std::move(the_device)),
        patient(std::move(the_patient)),
        plan(plan_press(model, model.parameters, motion, device, patient)) {}

  test::Setup model;
  Exoskeleton device;
  PatientParameters patient;
  PressPlan plan;
};

Planned on_scene(const std::string& name) {
  const SceneDescription scene = load_scene(name);
  return {test::Setup(build_model(scene), scene.parameters), build_motion(scene), load_device(scene),
          load_patient(scene)};
}

Planned on_slab() {
  return {test::finger_above_slab(), test::flexion(0.4, 0.4), test::two_joint_device(),
          test::steady_patient()};
}

/// Where the contact's material point is along n with the digit at these angles [m].
double along_normal(const Planned& planned, int digit, const JointArray& angle) {
  const DigitPress& press = *planned.plan.digit[idx(digit)];
  DigitPose pose;
  planned.model.hand.digit_pose(digit, digit_angles(angle, digit), pose);
  return press.normal.dot(pose.segment[idx(press.segment % kSegmentsPerDigit)] * press.p_S);
}

/// The digit's angles, moved by `x` times `direction`, coupled joints with those that they follow if
/// `with_coupled`.
JointArray moved_by(const Planned& planned, int digit, const JointArray& direction, double x,
                    bool with_coupled) {
  JointArray angle = planned.plan.digit[idx(digit)]->contact;
  for (std::size_t j = 0; j < angle.size(); ++j) angle[j] += x * direction[j];
  if (!with_coupled) return angle;
  for (const CoupledJoint& joint : planned.device.coupled)
    angle[idx(joint.joint)] += joint.ratio * x * direction[idx(joint.of)];
  return angle;
}

/// Central difference of the point's way along n by the way along `direction`.
double slope(const Planned& planned, int digit, const JointArray& direction, bool with_coupled) {
  constexpr double kStep = 1e-6;
  return (along_normal(planned, digit, moved_by(planned, digit, direction, kStep, with_coupled)) -
          along_normal(planned, digit, moved_by(planned, digit, direction, -kStep, with_coupled))) /
         (2.0 * kStep);
}

void expect_arms_of_finite_differences(const Planned& planned) {
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!planned.plan.digit[idx(digit)]) continue;
    const DigitPress& press = *planned.plan.digit[idx(digit)];
    for (const ExoJoint& joint : planned.device.joints) {
      if (digit_of_joint(joint.joint) != digit) continue;
      JointArray turn{};
      turn[idx(joint.joint)] = 1.0;
      EXPECT_NEAR(press.g[idx(joint.joint)], slope(planned, digit, turn, true), 1e-8)
          << joint_name(joint.joint);
    }
  }
}

void expect_one_metre_a_metre(const Planned& planned) {
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!planned.plan.digit[idx(digit)]) continue;
    const DigitPress& press = *planned.plan.digit[idx(digit)];
    EXPECT_NEAR(slope(planned, digit, press.into, false), -1.0, 1e-6) << digit_name(digit);
  }
}

/// A force f along n turns each joint by g f / k, coupled joints with theirs: the press backwards by f / kh.
void expect_give_way_along_the_press(const Planned& planned) {
  constexpr double kForce = 2.0;
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!planned.plan.digit[idx(digit)]) continue;
    const DigitPress& press = *planned.plan.digit[idx(digit)];
    JointArray turned{};
    for (std::size_t j = 0; j < turned.size(); ++j)
      if (planned.patient.stiffness[j] > 0.0) turned[j] = press.g[j] * kForce / planned.patient.stiffness[j];
    for (const ExoJoint& joint : planned.device.joints) {
      const std::size_t j = idx(joint.joint);
      if (digit_of_joint(joint.joint) == digit) {
        EXPECT_NEAR(turned[j], -press.into[j] * kForce / press.stiffness, 1e-12) << joint_name(joint.joint);
      }
    }
    EXPECT_NEAR(slope(planned, digit, turned, true), kForce / press.stiffness, 1e-8) << digit_name(digit);
  }
}

TEST(PressPlan, FindsTheFirstContactAndItsNormal) {
  const Planned planned = on_slab();
  ASSERT_TRUE(planned.plan.digit[kIndex]);
  const DigitPress& press = *planned.plan.digit[kIndex];
  EXPECT_EQ(press.segment, test::kTip);
  EXPECT_NEAR((press.normal - Vec3::UnitY()).norm(), 0.0, 1e-9);
  // The first step of the host that has a contact: up to 5 ms x 0.4 rad/s x 85 mm too late, on the surface.
  EXPECT_NEAR(press.point.y(), -0.020, 2e-4);
  EXPECT_NEAR(along_normal(planned, kIndex, press.contact), press.point.y(), 1e-12);
  for (int digit = 0; digit < kDigits; ++digit)
    if (digit != kIndex) {
      EXPECT_FALSE(planned.plan.digit[idx(digit)]) << digit_name(digit);
    }
}

TEST(PressPlan, OpensTheHandThatTheModelOpens) {
  EXPECT_EQ(on_slab().plan.open, test::simple_parameters().open_angle);
  const Planned planned = on_scene("stability_press");
  EXPECT_EQ(planned.plan.open, planned.model.hand.parameters().open_angle);
}

TEST(PressPlan, HasTheArmsThatFiniteDifferencesGive) {
  expect_arms_of_finite_differences(on_slab());
  expect_arms_of_finite_differences(on_scene("stability_press"));
  expect_arms_of_finite_differences(on_scene("stability_grasp"));
}

TEST(PressPlan, MovesTheContactsPointByXIntoTheObject) {
  expect_one_metre_a_metre(on_slab());
  expect_one_metre_a_metre(on_scene("stability_press"));
  expect_one_metre_a_metre(on_scene("stability_grasp"));
}

TEST(PressPlan, GivesWayToAForceAlongThePressByTheForceOverTheStiffness) {
  expect_give_way_along_the_press(on_slab());
  expect_give_way_along_the_press(on_scene("stability_press"));
  expect_give_way_along_the_press(on_scene("stability_grasp"));
}

// The DIP follows the PIP at half its angle.
TEST(PressPlan, MovesACoupledJointWithTheOneThatItFollows) {
  const Planned planned = on_slab();
  const DigitPress& press = *planned.plan.digit[kIndex];
  EXPECT_GT(press.into[idx(kPip)], 0.0);
  EXPECT_DOUBLE_EQ(press.into[idx(kDip)], 0.5 * press.into[idx(kPip)]);
  EXPECT_EQ(press.g[idx(kDip)], 0.0);  // no joint of the device
}

TEST(PressPlan, PlansIndexAndThumbOfTheGraspAndTheIndexAloneOfThePress) {
  const Planned press = on_scene("stability_press");
  const Planned grasp = on_scene("stability_grasp");
  const std::array<bool, kDigits> of_press = {false, true, false, false, false};
  const std::array<bool, kDigits> of_grasp = {true, true, false, false, false};
  for (std::size_t d = 0; d < kDigits; ++d) {
    EXPECT_EQ(press.plan.digit[d].has_value(), of_press[d]) << digit_name(static_cast<int>(d));
    EXPECT_EQ(grasp.plan.digit[d].has_value(), of_grasp[d]) << digit_name(static_cast<int>(d));
  }
}

// docs/stability.md: 700 N/m at the fingertip, in the pose in which the index finger meets the teapot.
TEST(PressPlan, FeelsThePatientsStiffnessAtTheFingertip) {
  EXPECT_NEAR(on_scene("stability_press").plan.digit[kIndex]->stiffness, 700.0, 7.0);
}

TEST(PressPlan, RefusesAMotionThatMeetsNothing) {
  const auto plan = [] {
    const test::Setup slab = test::finger_above_slab();
    return plan_press(slab, slab.parameters, test::flexion(0.05, 0.05), test::two_joint_device(),
                      test::steady_patient());
  };
  EXPECT_THROW((void)plan(), std::invalid_argument);
}

TEST(PressPlan, RefusesAPatientWithoutStiffnessWhereItPresses) {
  PatientParameters slack = test::steady_patient();
  slack.stiffness.fill(0.0);
  const test::Setup slab = test::finger_above_slab();
  try {
    (void)plan_press(slab, slab.parameters, test::flexion(0.4, 0.4), test::two_joint_device(), slack);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("index"));
  }
}

// A joint without a spring is not what the patient presses with, and gives way at no stiffness of its own.
TEST(PressPlan, PressesWithTheJointsThatHaveAStiffness) {
  PatientParameters patient = test::steady_patient();
  patient.stiffness[idx(kPip)] = 0.0;
  const Planned planned(test::finger_above_slab(), test::flexion(0.4, 0.4), test::two_joint_device(),
                        patient);
  const DigitPress& press = *planned.plan.digit[kIndex];
  EXPECT_EQ(press.into[idx(kPip)], 0.0);
  EXPECT_NE(press.g[idx(kPip)], 0.0);
  EXPECT_NEAR(press.stiffness, 10.0 / (press.g[idx(kMcp)] * press.g[idx(kMcp)]), 1e-9 * press.stiffness);
  EXPECT_NEAR(slope(planned, kIndex, press.into, false), -1.0, 1e-6);
}

}  // namespace
}  // namespace phalanx
