// SPDX-License-Identifier: Apache-2.0
// A simulated patient whose index finger is clenched inside a slab when the host begins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "phalanx/simulation/simulated_exoskeleton.h"
#include "simulation/pressing_finger.h"

namespace phalanx {
namespace {

using test::kIndex;
using test::kMcp;
using test::kPip;

enum class Patient {
  kClenched,  ///< holds the finger where it is
  kLimp,      ///< lets it be moved
};

class ClenchedFinger {
 public:
  explicit ClenchedFinger(ContactMode mode)
      : model_(slab(mode)),
        state_(model_, model_.parameters),
        device_(damped(), patient(), JointArray{}, bent(), 1) {}

  void tick(Patient patient = Patient::kClenched) {
    device_.measure_tick();
    const double before = force();
    step(model_, model_.parameters, device_.sample(), state_);
    largest_rise = std::max(largest_rise, force() - before);
    largest_force = std::max(largest_force, force());
    for (const double torque : now().torque) largest_torque = std::max(largest_torque, std::abs(torque));
    device_.drive(now().torque);
    const JointArray held = patient == Patient::kClenched ? bent() : device_.plant().angle();
    device_.end_tick({.from = held, .to = held, .push = {}});
  }
  void run(double seconds, Patient patient = Patient::kClenched) {
    largest_torque = largest_force = largest_rise = 0.0;
    for (int i = 0; i < static_cast<int>(1000.0 * seconds + 0.5); ++i) tick(patient);
  }
  /// Of all contacts of the finger [N].
  [[nodiscard]] double force() const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& segment = now().segment[idx(segment_index(kIndex, k))];
      sum += segment.force * segment.normal;
    }
    return sum.norm();
  }
  [[nodiscard]] const Snapshot& now() const { return state_.snapshot(); }
  [[nodiscard]] const DigitOpening& opening() const { return now().opening[idx(kIndex)]; }
  bool confirm() { return state_.confirm_opening(kIndex); }
  HapticState& state() { return state_; }

  double largest_torque = 0.0;  ///< of any joint since run() began [Nm]
  double largest_force = 0.0;   ///< [N]
  double largest_rise = 0.0;    ///< of the force from tick to tick [N]

 private:
  static test::Setup slab(ContactMode mode) {
    test::Setup model = test::finger_above_slab();
    model.parameters.rate_hz = 1000.0;
    model.parameters.contact.mode = mode;
    return model;
  }
  static Exoskeleton damped() {
    Exoskeleton exo = test::two_joint_device();
    for (ExoJoint& joint : exo.joints) joint.damping = 0.05;
    return exo;
  }
  static PatientParameters patient() {
    PatientParameters patient = test::steady_patient();
    patient.damping[idx(kMcp)] = 0.05;
    patient.damping[idx(kPip)] = 0.02;
    return patient;
  }
  /// The fingertip is about 18 mm inside the slab.
  static JointArray bent() {
    JointArray q{};
    q[idx(kMcp)] = 0.4;
    q[idx(kPip)] = 0.2;
    return q;
  }

  test::Setup model_;
  HapticState state_;
  SimulatedExoskeleton device_;
};

class OpeningOf : public ::testing::TestWithParam<ContactMode> {};

TEST_P(OpeningOf, AClenchedPatientGetsNoUnconfirmedTorque) {
  ClenchedFinger finger(GetParam());
  finger.run(10.0);
  EXPECT_EQ(finger.opening().phase, OpeningPhase::kUnconfirmed);
  EXPECT_GT(finger.opening().way, 10e-3);
  EXPECT_EQ(finger.largest_torque, 0.0);
  EXPECT_TRUE(has(finger.now().status, Status::kStartInside));
  EXPECT_FALSE(finger.state().confirm_opening(-1));
  EXPECT_FALSE(finger.state().confirm_opening(kDigits));
  EXPECT_FALSE(finger.state().confirm_opening(0)) << "the thumb is not inside";
  finger.run(0.1);
  EXPECT_EQ(finger.largest_torque, 0.0);
}

TEST_P(OpeningOf, AClenchedPatientIsPushedByOneNewtonForThreeSeconds) {
  ClenchedFinger finger(GetParam());
  finger.run(0.1);
  ASSERT_TRUE(finger.confirm());
  finger.run(0.5);
  EXPECT_NEAR(finger.force(), 0.5, 0.01);
  finger.run(2.0);
  EXPECT_NEAR(finger.force(), 1.0, 1e-9);
  EXPECT_EQ(finger.opening().phase, OpeningPhase::kConfirmed);
  finger.run(4.0);
  EXPECT_LE(finger.largest_force, 1.0 + 1e-9);
  EXPECT_EQ(finger.opening().phase, OpeningPhase::kNotFollowed);
  finger.run(5.0);
  EXPECT_EQ(finger.largest_torque, 0.0);
  ASSERT_TRUE(finger.confirm());
  finger.run(1.5);
  EXPECT_NEAR(finger.largest_rise, 1e-3, 1e-6) << "1 N/s, also the second time";
}

TEST_P(OpeningOf, AFingerThatFollowsLeavesTheObjectAndThenFeelsIt) {
  ClenchedFinger finger(GetParam());
  finger.run(0.1);
  ASSERT_TRUE(finger.confirm());
  int ticks = 0;
  do finger.tick(Patient::kLimp);
  while (finger.opening().phase == OpeningPhase::kConfirmed && ++ticks < 60'000);
  EXPECT_EQ(finger.opening().phase, OpeningPhase::kNone) << "after " << ticks << " ms";
  EXPECT_LE(finger.largest_force, 1.0 + 1e-9);
  EXPECT_FALSE(has(finger.now().status, Status::kStartInside));
  finger.run(1.0);  // the patient closes again
  EXPECT_GT(finger.largest_force, 2.0);
}

TEST_P(OpeningOf, AWithdrawnConfirmationEndsTheForceAtOnce) {
  ClenchedFinger finger(GetParam());
  finger.run(0.1);
  ASSERT_TRUE(finger.confirm());
  finger.run(1.0);
  EXPECT_GT(finger.force(), 0.9);
  finger.state().withdraw_openings();
  finger.tick();
  EXPECT_EQ(finger.force(), 0.0);
  finger.run(1.0);
  EXPECT_EQ(finger.largest_torque, 0.0);
  EXPECT_EQ(finger.opening().phase, OpeningPhase::kUnconfirmed);
}

INSTANTIATE_TEST_SUITE_P(Static, OpeningOf, ::testing::Values(ContactMode::kStatic));
INSTANTIATE_TEST_SUITE_P(Sliding, OpeningOf, ::testing::Values(ContactMode::kSliding));

}  // namespace
}  // namespace phalanx
