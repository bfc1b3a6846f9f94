// SPDX-License-Identifier: Apache-2.0
// The force stage on contact records that are written by hand: what a search would find does not matter here.
#include "phalanx/force/force_stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_law.h"
#include "phalanx/mesh/primitives.h"
#include "support/all_stabilisers.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr double kTick = 0.005;  // [s]
constexpr int kProximal = 0;
constexpr int kDistal = 2;
constexpr int kThumbBefore = 0;                                  ///< the digit before the index finger
const double kGain = 1.0 - std::exp(-2.0 * kPi * 30.0 * kTick);  ///< of a low-pass of 30 Hz: 0.61034

/// The simple hand, open and straight along -Z, with records of our own and every limiter off.
class Stage {
 public:
  Stage() {
    limits.fingertip_force_enabled = false;
    limits.joint_torque_enabled = false;
    limits.torque_rate_enabled = false;
    hand_.poses(hand_.parameters().open_angle, hcp);
    state.hcp_before = hcp;
  }

  /// The segment's point 10 mm from its joint presses something below it: the finger is pushed towards +Y.
  ContactRecord& press(int k, double depth, const Vec3& normal = Vec3::UnitY(), int digit = test::kIndex) {
    ContactRecord& record = contacts_.record[idx(segment_index(digit, k))];
    record.active = true;
    record.p_S = Vec3(0.0, 0.0, -0.010);
    record.n_c = record.force_normal = normal;
    record.depth = depth;
    record.p_hcp = hcp.digit[idx(digit)].segment[idx(k)] * record.p_S;
    record.p_gdp = contacts_.poses.digit[idx(digit)].segment[idx(k)] * record.p_S;
    return record;
  }
  void leave(int k, int digit = test::kIndex) {
    contacts_.record[idx(segment_index(digit, k))].active = false;
  }
  /// The measured finger moves by so much, all segments alike.
  void move_hcp(const Vec3& by) {
    for (Pose& segment : hcp.digit[idx(test::kIndex)].segment) segment.p += by;
  }
  Status tick() {
    return compute_command({hand_, law, smoothing, limits, period, stabiliser, oscillation}, contacts_, hcp,
                           stale, state);
  }
  Status ticks(int count) {
    Status status = Status::kOk;
    for (int i = 0; i < count; ++i) status = tick();
    return status;
  }
  [[nodiscard]] double sent(int k, int digit = test::kIndex) const {
    return state.segment[idx(segment_index(digit, k))].sent;
  }
  [[nodiscard]] const LocalWall& wall(int k, int digit = test::kIndex) const {
    return state.wall[idx(segment_index(digit, k))];
  }
  [[nodiscard]] double torque(int i, int digit = test::kIndex) const {
    return state.torque[idx(joint_index(digit, i))];
  }

  ForceLawParameters law{.law = ForceLaw::kHooke, .stiffness = 500.0};
  SmoothingParameters smoothing;
  LimitParameters limits;
  StabiliserParameters stabiliser{.method = Stabiliser::kNone};
  OscillationParameters oscillation;
  ForceState state;
  HandPoses hcp;
  bool stale = false;
  double period = kTick;

 private:
  HandModel hand_ = test::simple_hand();
  SegmentTrees trees_ = make_segment_trees(hand_);
  ObjectModel object_{test::moved(make_box(Vec3(0.01, 0.01, 0.01), 12), test::at(10.0, 0.0, 0.0))};
  ContactParameters parameters_;
  GdpState contacts_{ContactModel{hand_, trees_, object_, parameters_}};
};

// ---- the law's slope ----

// By hand, k = 500 N/m. Hunt-Crossley's slope is k n (d / 1 mm)^(n - 1): 750 N/m at 1 mm and 1500 at 4 mm for
// n = 1.5, 4000 at 4 mm for n = 2. Duffing at 2 mm: 500 + 3 x 5e7 x 4e-6 = 1100. Linear to 2 mm, then cubic,
// at 3 mm: 500 + 3 x 5e7 x 1e-6 = 650.
TEST(LawSlope, IsWhatTheLawsDerivativeIsByHand) {
  ForceLawParameters law{.law = ForceLaw::kHuntCrossley, .stiffness = 500.0, .hunt_crossley_exponent = 1.5};
  EXPECT_NEAR(law_slope(law, 1e-3), 750.0, 1e-9);
  EXPECT_NEAR(law_slope(law, 4e-3), 1500.0, 1e-9);
  law.hunt_crossley_exponent = 2.0;
  EXPECT_NEAR(law_slope(law, 4e-3), 4000.0, 1e-9);
  EXPECT_EQ(law_slope(law, 0.0), 0.0);
  EXPECT_EQ(law_slope(law, -1e-3), 0.0);
  law.hunt_crossley_exponent = 1.0;
  EXPECT_EQ(law_slope(law, 7e-3), 500.0);
  law = {.law = ForceLaw::kDuffing, .stiffness = 500.0, .cubic = 5e7};
  EXPECT_NEAR(law_slope(law, 2e-3), 1100.0, 1e-9);
  EXPECT_EQ(law_slope(law, -2e-3), 500.0) << "below the surface its slope there";
  law = {.law = ForceLaw::kLinearThenCubic, .stiffness = 500.0, .cubic = 5e7, .linear_depth = 2e-3};
  EXPECT_EQ(law_slope(law, 1e-3), 500.0);
  EXPECT_EQ(law_slope(law, 2e-3), 500.0);
  EXPECT_NEAR(law_slope(law, 3e-3), 650.0, 1e-9);
  law = {.law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 9.0};
  EXPECT_EQ(law_slope(law, 3e-3), 500.0) << "at rest";
}

// The same against the force itself, by central differences of 1 nm.
TEST(LawSlope, IsTheDifferenceQuotientOfTheForceAtRest) {
  for (const ForceLaw kind : {ForceLaw::kHooke, ForceLaw::kKelvinVoigt, ForceLaw::kHuntCrossley,
                              ForceLaw::kDuffing, ForceLaw::kLinearThenCubic}) {
    for (const double n : {1.0, 1.5, 2.2, 3.0}) {
      const ForceLawParameters law{.law = kind, .stiffness = 700.0, .hunt_crossley_exponent = n};
      for (const double depth : {0.3e-3, 1.1e-3, 1.9e-3, 2.6e-3, 6e-3}) {
        const double h = 1e-9;
        const double quotient = (law_force(law, depth + h, 0.0) - law_force(law, depth - h, 0.0)) / (2.0 * h);
        EXPECT_NEAR(law_slope(law, depth), quotient, 1e-5 * quotient)
            << static_cast<int>(kind) << " " << depth;
      }
    }
  }
}

// ---- the closing speed ----

// The object pushes towards +Y, and the finger goes 1 mm towards -Y in 5 ms: it closes at +0.2 m/s. 2 mm into
// 500 N/m with 2 N s/m are 1 N + 0.4 N. At rest again, 1 N; opening at 0.1 m/s, 0.8 N.
TEST(ForceStage, AFingerThatMovesIntoTheObjectClosesWithAPositiveSpeed) {
  Stage stage;
  stage.law = {.law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 2.0, .velocity_lowpass_hz = 1e6};
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.0, 1e-12) << "nothing is known of the tick before the first";
  stage.move_hcp({0.0, -1e-3, 0.0});
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.4, 1e-12);
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.0, 1e-12) << "it rests";
  stage.move_hcp({3e-3, 0.5e-3, -1e-3});  // what is not along the normal is not closing
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 0.8, 1e-12);
}

// Of 0.2 m/s the low-pass of 30 Hz lets through 1 - exp(-2 pi 30 x 0.005) = 0.61034 in the first step, and of
// the rest as much in the second. Without contact it forgets.
TEST(ForceStage, TheClosingSpeedIsLowPassedAndForgottenWithTheContact) {
  Stage stage;
  stage.law.velocity_lowpass_hz = 30.0;
  stage.press(kDistal, 2e-3);
  stage.tick();
  const SegmentForce& force = stage.state.segment[idx(segment_index(test::kIndex, kDistal))];
  for (const double expected : {0.2 * kGain, 0.2 * (1.0 - (1.0 - kGain) * (1.0 - kGain))}) {
    stage.move_hcp({0.0, -1e-3, 0.0});
    stage.press(kDistal, 2e-3);
    stage.tick();
    EXPECT_NEAR(force.speed, expected, 1e-12);
  }
  stage.leave(kDistal);
  stage.tick();
  EXPECT_EQ(force.speed, 0.0);
}

// The law's own damper takes the low-passed speed: 1 N + 2 N s/m x 0.2 m/s x 0.61034.
TEST(ForceStage, TheLawTakesTheLowPassedSpeed) {
  Stage stage;
  stage.law = {
      .law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 2.0, .velocity_lowpass_hz = 30.0};
  stage.press(kDistal, 2e-3);
  stage.tick();
  stage.move_hcp({0.0, -1e-3, 0.0});
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.0 + 0.4 * kGain, 1e-12);
}

// The depth is along the triangle's normal, and so is its rate: 1.4 N as above, whatever the direction of the
// force. Along that one it would be 0.16 m/s.
TEST(ForceStage, TheClosingSpeedIsAlongTheTrianglesNormal) {
  Stage stage;
  stage.law = {.law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 2.0, .velocity_lowpass_hz = 1e6};
  stage.press(kDistal, 2e-3).force_normal = Vec3(0.6, 0.8, 0.0);
  stage.tick();
  stage.move_hcp({0.0, -1e-3, 0.0});
  stage.press(kDistal, 2e-3).force_normal = Vec3(0.6, 0.8, 0.0);
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.4, 1e-12);
}

// Before the first tick the hand was nowhere: no speed is made of the way from there.
TEST(ForceStage, TheFirstTickOfAllKnowsNoSpeed) {
  Stage stage;
  stage.state = {};
  stage.law = {.law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 2.0, .velocity_lowpass_hz = 1e6};
  stage.press(kDistal, 2e-3, Vec3::UnitZ());
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.0, 1e-12);
}

// A contact without depth sends nothing; when it goes, so does its speed, whichever segment's it is.
TEST(ForceStage, AContactThatWasNeverFeltLeavesNothingBehind) {
  for (const int k : {kProximal, 1, kDistal}) {
    Stage stage;
    stage.law.velocity_lowpass_hz = 30.0;
    const SegmentForce& force = stage.state.segment[idx(segment_index(test::kIndex, k))];
    stage.press(k, 0.0);
    stage.tick();
    stage.move_hcp({0.0, -1e-3, 0.0});
    stage.press(k, 0.0);
    stage.tick();
    EXPECT_NEAR(force.speed, 0.2 * kGain, 1e-12) << k;
    stage.leave(k);
    stage.tick();
    EXPECT_EQ(force.speed, 0.0) << k;
    EXPECT_EQ(force.normal, Vec3::Zero()) << k;
  }
}

// A damper of 4 N s/m beside Hooke's law takes the low-passed speed, time-domain passivity that of the step.
TEST(ForceStage, KelvinVoigtTakesTheLowPassedSpeedAndPassivityTheSteps) {
  for (const Stabiliser method : {Stabiliser::kKelvinVoigt, Stabiliser::kPassivity}) {
    Stage stage;
    stage.law.velocity_lowpass_hz = 30.0;
    stage.stabiliser = {.method = method, .damping = 4.0, .passivity_damping_max = 50.0};
    stage.press(kDistal, 2e-3);
    stage.tick();
    EXPECT_NEAR(stage.sent(kDistal), 1.0, 1e-12);
    stage.move_hcp({0.0, 1e-3, 0.0});  // opens at 0.2 m/s
    stage.press(kDistal, 2e-3);
    stage.tick();
    // E = 0.005 x 1 N x -0.2 = -1 mJ, a = 1e-3 / (0.005 x 0.04) = 5 N s/m, 1 - 5 x 0.2 = 0.
    EXPECT_NEAR(stage.sent(kDistal), method == Stabiliser::kPassivity ? 0.0 : 1.0 - 4.0 * 0.2 * kGain, 1e-12);
  }
}

// At 1 kHz smoothing's 20 N/s are 0.02 N a step.
TEST(ForceStage, TheStabiliserTakesTheModelsPeriod) {
  Stage stage;
  stage.period = 1e-3;
  stage.stabiliser.method = Stabiliser::kSmoothing;
  stage.press(kDistal, 2e-3);
  for (int n = 1; n <= 3; ++n) {
    stage.tick();
    EXPECT_NEAR(stage.sent(kDistal), 0.02 * n, 1e-12) << n;
  }
}

// ---- what is silent, stale or gone ----

TEST(ForceStage, ASilentContactAndAStaleHandPushNothing) {
  Stage stage;
  stage.press(kDistal, 2e-3).silent = true;
  stage.tick();
  EXPECT_EQ(stage.sent(kDistal), 0.0);
  stage.press(kDistal, 2e-3).silent = false;
  stage.stale = true;
  stage.tick();
  EXPECT_EQ(stage.sent(kDistal), 0.0);
  stage.stale = false;
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.0, 1e-12);
}

// The same of each method while the finger goes on into the object, where a damper would push and a bound on
// the energy hold what was sent. Smoothing and the low-pass let it decay.
TEST(ForceStage, NoMethodPushesForASilentContactOrAStaleHand) {
  for (const Stabiliser method : test::kAllStabilisers) {
    if (method == Stabiliser::kSmoothing || method == Stabiliser::kLowPass) continue;
    for (const bool silent : {false, true}) {
      Stage stage;
      stage.stabiliser.method = method;
      stage.press(kDistal, 2e-3);
      stage.tick();
      EXPECT_GT(stage.sent(kDistal), 0.0) << static_cast<int>(method);
      stage.stale = !silent;
      stage.move_hcp({0.0, -1e-3, 0.0});
      stage.press(kDistal, 3e-3).silent = silent;
      stage.tick();
      EXPECT_EQ(stage.sent(kDistal), 0.0) << static_cast<int>(method) << " " << silent;
    }
  }
}

// 1e110 m into a cubic law overflow, and a point whose x is not a number has no torque: nothing is sent, and
// the status says so.
TEST(ForceStage, WhatIsNotFiniteIsNotSentAndSaid) {
  Stage overflow;
  overflow.limits.fingertip_force_enabled = true;
  overflow.law = {.law = ForceLaw::kDuffing, .stiffness = 500.0, .cubic = 5e7};
  overflow.press(kDistal, 1e110);
  EXPECT_TRUE(has(overflow.tick(), Status::kCommandNotFinite));
  EXPECT_EQ(overflow.sent(kDistal), 0.0);
  EXPECT_EQ(overflow.torque(0), 0.0);

  for (const bool limited : {false, true}) {
    Stage nowhere;
    nowhere.limits.joint_torque_enabled = nowhere.limits.torque_rate_enabled = limited;
    nowhere.press(kDistal, 2e-3).p_S.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(has(nowhere.tick(), Status::kCommandNotFinite));
    for (int i = 0; i < kJointsPerDigit; ++i) EXPECT_EQ(nowhere.torque(i), 0.0) << i;
    nowhere.press(kDistal, 2e-3);
    nowhere.ticks(20);
    EXPECT_NEAR(nowhere.torque(0), -0.075, 1e-12) << "and the next command is whole";
  }

  Stage unfelt;
  unfelt.press(kDistal, 0.0).p_S.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(unfelt.tick(), Status::kOk) << "what pushes nothing has no torque, wherever it is";
}

// What is not felt turns at once: after a contact without depth along +Y the first force goes along +X.
TEST(ForceStage, ADirectionThatIsNotFeltIsNotKept) {
  Stage stage;
  stage.stabiliser.method = Stabiliser::kDirection;
  stage.press(kDistal, 0.0, Vec3::UnitY());
  stage.tick();
  stage.press(kDistal, 2e-3, Vec3::UnitX());
  stage.tick();
  EXPECT_EQ(stage.state.segment[idx(segment_index(test::kIndex, kDistal))].normal, Vec3::UnitX());
}

// The direction of a force that still decays stays; once nothing is sent and nothing touches, it is
// forgotten.
TEST(ForceStage, TheNormalOutlivesTheContactAsLongAsAForceIsSent) {
  Stage stage;
  stage.stabiliser.method = Stabiliser::kSmoothing;
  stage.press(kDistal, 2e-3);
  stage.ticks(3);  // 0.3 N
  const SegmentForce& force = stage.state.segment[idx(segment_index(test::kIndex, kDistal))];
  stage.leave(kDistal);
  for (const double expected : {0.2, 0.1}) {
    stage.tick();
    EXPECT_NEAR(force.sent, expected, 1e-12);
    EXPECT_EQ(force.normal, Vec3::UnitY());
    EXPECT_NEAR(stage.torque(0), -0.075 * expected, 1e-12) << "40 + 25 + 10 mm from the knuckle";
  }
  stage.ticks(2);
  EXPECT_EQ(force.sent, 0.0);
  EXPECT_EQ(force.normal, Vec3::Zero());
  EXPECT_EQ(stage.torque(0), 0.0);
  stage.press(kDistal, 0.0);
  stage.tick();
  EXPECT_EQ(force.normal, Vec3::UnitY()) << "a contact without depth has one";
}

// The digit is not free, for its first segment still presses.
TEST(ForceStage, ASegmentThatLetsGoBesideOneThatPressesHasNoNormal) {
  Stage stage;
  stage.press(kDistal, 2e-3);
  stage.press(kProximal, 2e-3);
  stage.tick();
  stage.leave(kDistal);
  stage.tick();
  EXPECT_EQ(stage.state.segment[idx(segment_index(test::kIndex, kDistal))].normal, Vec3::Zero());
  EXPECT_EQ(stage.state.segment[idx(segment_index(test::kIndex, kProximal))].normal, Vec3::UnitY());
}

// ---- digits ----

// The thumb is the digit before the index finger, whose first segment presses all the while: 1 N, of which
// smoothing sends 0.1 N more each tick, 10 mm from the knuckle. The thumb's 0.05 N are 75 mm from its own.
TEST(ForceStage, ADigitLeavesTheNextOneAlone) {
  Stage stage;
  stage.stabiliser.method = Stabiliser::kSmoothing;
  stage.press(kDistal, 0.1e-3, Vec3::UnitY(), kThumbBefore);
  stage.press(kProximal, 2e-3);
  stage.ticks(2);
  EXPECT_NEAR(stage.torque(0, kThumbBefore), -0.075 * 0.05, 1e-12);
  EXPECT_NEAR(stage.torque(0), -0.010 * 0.2, 1e-12);
  stage.leave(kDistal, kThumbBefore);
  stage.ticks(3);
  EXPECT_TRUE(stage.state.resting[idx(kThumbBefore)]);
  EXPECT_NEAR(stage.sent(kProximal), 0.5, 1e-12);
}

// ---- limits ----

// 4 N on each of two segments along the same normal and a cap of 5 N on the digit: 2.5 N each, and it is
// said.
TEST(ForceStage, TheDigitsSumIsCappedAndSaid) {
  Stage stage;
  stage.limits.fingertip_force_enabled = true;
  stage.press(kDistal, 8e-3);
  stage.press(kProximal, 8e-3);
  const Status status = stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 2.5, 1e-12);
  EXPECT_NEAR(stage.sent(kProximal), 2.5, 1e-12);
  EXPECT_TRUE(has(status, Status::kForceLimited));
  stage.press(kDistal, 4e-3);
  stage.press(kProximal, 4e-3, -Vec3::UnitY());
  EXPECT_FALSE(has(stage.tick(), Status::kForceLimited)) << "forces that are opposite add up to nothing";
  EXPECT_NEAR(stage.sent(kDistal), 2.0, 1e-12);
}

// The law's forces are brought within the cap before they are smoothed: 8 N, of which 5 N are capped, and 2 N
// become 5/7 of 5 and 2 N. After it alone the two would come to other shares.
TEST(ForceStage, TheDigitsSumIsCappedBeforeTheStabiliserToo) {
  Stage stage;
  stage.limits.fingertip_force_enabled = true;
  stage.stabiliser.method = Stabiliser::kSmoothing;
  stage.press(kDistal, 16e-3);
  stage.press(kProximal, 4e-3);
  stage.ticks(100);
  EXPECT_NEAR(stage.sent(kDistal), 25.0 / 7.0, 1e-9);
  EXPECT_NEAR(stage.sent(kProximal), 10.0 / 7.0, 1e-9);
}

// Of 5 N and half a micronewton the cap takes half a micronewton: it does not count as having acted. With one
// and a half it does.
TEST(ForceStage, ACapThatTakesLessThanAMicronewtonHasNotActed) {
  for (const double beyond : {0.5e-6, 1.5e-6}) {
    Stage stage;
    stage.limits.fingertip_force_enabled = true;
    stage.press(kDistal, 10e-3 + beyond / 500.0);
    EXPECT_EQ(has(stage.tick(), Status::kForceLimited), beyond > 1e-6) << beyond;
    EXPECT_NEAR(stage.sent(kDistal), 5.0, 1e-12) << beyond;
  }
  // 1 um into 2 N/m are 2 uN, of which a cap of 1 uN takes one.
  Stage stage;
  stage.limits.fingertip_force_enabled = true;
  stage.limits.fingertip_force = 1e-6;
  stage.law.stiffness = 2.0;
  stage.press(kDistal, 1e-6);
  EXPECT_FALSE(has(stage.tick(), Status::kForceLimited)) << "a micronewton itself";
  EXPECT_EQ(stage.sent(kDistal), 1e-6);
}

// 12 mm into 500 N/m are 6 N, also beside a damper where no cap is on. With one of 5 N, 10 mm are 5 N, which
// the cap leaves alone.
TEST(ForceStage, ACapThatIsOffOrJustReachedLeavesADampedContactAlone) {
  Stage stage;
  stage.stabiliser = {.method = Stabiliser::kKelvinVoigt, .damping = 4.0};
  stage.press(kDistal, 12e-3);
  EXPECT_EQ(stage.tick(), Status::kOk);
  EXPECT_NEAR(stage.sent(kDistal), 6.0, 1e-12);
  stage.limits.fingertip_force_enabled = true;
  stage.press(kDistal, 10e-3);
  EXPECT_EQ(stage.tick(), Status::kOk);
  EXPECT_EQ(stage.sent(kDistal), 5.0);
}

// A damper may bring a contact above the cap; smoothing keeps below the law by itself.
TEST(ForceStage, AMethodThatAddsToTheLawIsCappedOnEachContactAgain) {
  Stage stage;
  stage.limits.fingertip_force_enabled = true;
  stage.limits.fingertip_force = 1.2;
  stage.law.velocity_lowpass_hz = 1e6;
  stage.stabiliser = {.method = Stabiliser::kKelvinVoigt, .damping = 4.0};
  stage.press(kDistal, 2e-3);
  stage.tick();
  stage.move_hcp({0.0, -1e-3, 0.0});
  stage.press(kDistal, 2e-3);
  EXPECT_TRUE(has(stage.tick(), Status::kForceLimited)) << "1 N + 0.8 N";
  EXPECT_NEAR(stage.sent(kDistal), 1.2, 1e-12);
  // Against each other two such contacts add up to nothing, so that the sum says nothing of either.
  stage.move_hcp({0.0, -1e-3, 0.0});
  stage.press(kDistal, 2e-3);
  stage.press(kProximal, 2e-3).force_normal = -Vec3::UnitY();
  EXPECT_TRUE(has(stage.tick(), Status::kForceLimited));
  EXPECT_NEAR(stage.sent(kDistal), 1.2, 1e-12);
  EXPECT_NEAR(stage.sent(kProximal), 1.2, 1e-12);
}

// Two times 2 N, and two times 2.8 N with a damper of 4 N s/m at 0.2 m/s: each within 5 N, together 5.6 N.
TEST(ForceStage, ASumThatTheStabiliserBringsAboveTheCapIsCappedAndSaid) {
  Stage stage;
  stage.limits.fingertip_force_enabled = true;
  stage.law.velocity_lowpass_hz = 1e6;
  stage.stabiliser = {.method = Stabiliser::kKelvinVoigt, .damping = 4.0};
  stage.press(kDistal, 4e-3);
  stage.press(kProximal, 4e-3);
  EXPECT_FALSE(has(stage.tick(), Status::kForceLimited));
  EXPECT_NEAR(stage.sent(kDistal), 2.0, 1e-12);
  stage.move_hcp({0.0, -1e-3, 0.0});
  stage.press(kDistal, 4e-3);
  stage.press(kProximal, 4e-3);
  EXPECT_TRUE(has(stage.tick(), Status::kForceLimited));
  EXPECT_NEAR(stage.sent(kDistal), 2.5, 1e-12);
  EXPECT_NEAR(stage.sent(kProximal), 2.5, 1e-12);
}

// 4 mm into 500 N/m, capped to 1 N: a wall of 250 N/m in series with 1000 N/m, whose share is 3.2 mm: 0.8 N
// at rest. What would be sent without the cap is looked at, but does not move the proxy.
TEST(ForceStage, TheCouplingSettlesUnderTheCapAsByHand) {
  Stage stage;
  stage.limits.fingertip_force_enabled = true;
  stage.limits.fingertip_force = 1.0;
  stage.stabiliser = {
      .method = Stabiliser::kVirtualCoupling, .coupling_stiffness = 1000.0, .coupling_damping = 4.0};
  stage.press(kDistal, 4e-3);
  stage.ticks(200);
  EXPECT_NEAR(stage.sent(kDistal), 0.8, 1e-9);
}

// 75 mm x 4 N = 0.3 Nm wanted. A limit of 0.2 Nm, and a rate of 10 Nm/s: 0.05 Nm a tick, down and up alike.
TEST(ForceStage, TorqueIsLimitedAndRateLimitedBothWaysAndEachIsSaid) {
  Stage stage;
  stage.limits.joint_torque_enabled = true;
  stage.limits.joint_torque = 0.2;
  stage.press(kDistal, 8e-3);
  EXPECT_TRUE(has(stage.tick(), Status::kTorqueLimited));
  EXPECT_NEAR(stage.torque(0), -0.2, 1e-15);
  stage.press(kDistal, 1e-3);
  EXPECT_EQ(stage.tick(), Status::kOk);
  stage.limits.torque_rate_enabled = true;
  for (const double sign : {1.0, -1.0}) {
    stage.press(kDistal, 1e-12, sign * Vec3::UnitY());
    stage.ticks(20);
    stage.press(kDistal, 4e-3, sign * Vec3::UnitY());  // 2 N: 0.15 Nm
    for (int i = 1; i <= 2; ++i) {
      EXPECT_TRUE(has(stage.tick(), Status::kTorqueRateLimited)) << i;
      EXPECT_NEAR(stage.torque(0), -sign * 0.05 * i, 1e-9) << i;
    }
    stage.ticks(5);
    EXPECT_EQ(stage.tick(), Status::kOk);
    stage.leave(kDistal);
    for (int i = 1; i <= 2; ++i) {
      EXPECT_TRUE(has(stage.tick(), Status::kTorqueRateLimited)) << i;
      EXPECT_NEAR(stage.torque(0), -sign * (0.15 - 0.05 * i), 1e-9) << i;
    }
    stage.ticks(5);
  }
}

// ---- oscillation ----

// 1 and 3 N at 10 Hz: a swing of 2 N, which is one where a swing is more than 0.5 N, and none above 3 N.
TEST(ForceStage, ASwingIsWhatTheParametersSay) {
  for (const double swing : {0.5, 3.0}) {
    Stage stage;
    stage.oscillation.swing = swing;
    Status any = Status::kOk;
    for (int n = 0; n < 200; ++n) {
      stage.press(kDistal, n % 20 < 10 ? 2e-3 : 6e-3);
      any |= stage.tick();
    }
    EXPECT_EQ(has(any, Status::kOscillating), swing < 2.0) << swing;
  }
}

// 1 and 3 N, 50 ms each, on the index finger's first segment: 10 Hz, also while the thumb, the digit before,
// is watched.
TEST(ForceStage, AnOscillationHasItsOwnFrequencyBesideAnotherDigit) {
  Stage stage;
  stage.press(kDistal, 2e-3, Vec3::UnitY(), kThumbBefore);
  const OscillationObserver& observer = stage.state.observer[idx(segment_index(test::kIndex, kProximal))];
  for (int n = 0; n < 100; ++n) {
    stage.press(kProximal, n % 20 < 10 ? 2e-3 : 6e-3);
    stage.tick();
    EXPECT_FALSE(observer.idle()) << n;
  }
  EXPECT_NEAR(observer.frequency(), 10.0, 1e-9);
}

// The verdict on a finger that has left ends half a second later, also where its other segments were always
// at rest.
TEST(ForceStage, AFreeDigitIsWatchedUntilTheVerdictOfEachSegmentHasEnded) {
  for (const int k : {kProximal, 1, kDistal}) {
    Stage stage;
    stage.ticks(3);
    ASSERT_TRUE(stage.state.resting[idx(test::kIndex)]) << "it has rested once";
    for (int n = 0; n < 100; ++n) {
      stage.press(k, n % 20 < 10 ? 2e-3 : 6e-3);  // 1 and 3 N, 10 Hz
      stage.tick();
    }
    ASSERT_TRUE(has(stage.tick(), Status::kOscillating));
    stage.leave(k);
    EXPECT_TRUE(has(stage.ticks(80), Status::kOscillating)) << "0.4 s";
    EXPECT_FALSE(has(stage.ticks(40), Status::kOscillating)) << "0.6 s";
    EXPECT_TRUE(stage.state.resting[idx(test::kIndex)]);
  }
}

// The distal segment oscillates until 0.5 s and its verdict lasts to 1 s; the proximal one swings from 0.6 s
// on and fires about 0.85 s, when 0.5 s have passed since the first halving: the stiffness is halved again,
// although the segment that is looked at last does not swing any more.
TEST(ForceStage, AnOscillationOfAnySegmentHalvesTheStiffness) {
  Stage stage;
  stage.oscillation.reaction = OscillationReaction::kHalve;
  double first = -1.0;
  double second = -1.0;
  for (int n = 0; n < 200; ++n) {
    const double t = kTick * n;
    stage.press(kDistal, t < 0.5 && n % 20 < 10 ? 10e-3 : 2e-3);
    stage.press(kProximal, t >= 0.6 && n % 20 < 10 ? 18e-3 : 1e-3);
    const Status status = stage.tick();
    const double factor = stage.state.stiffness_factor.value();
    if (first < 0.0 && factor < 1.0) first = t;
    if (second < 0.0 && factor < 0.5 - 1e-9) second = t;
    if (t > 0.9) {
      EXPECT_TRUE(has(status, Status::kOscillating)) << t;
    }
  }
  EXPECT_GT(first, 0.1);
  EXPECT_LT(first, 0.3);
  EXPECT_GE(second, first + 0.5);
  EXPECT_LT(second, first + 0.5 + 0.3);
  EXPECT_LT(second, 0.95) << "within the distal segment's verdict";
}

// ---- local walls ----

Stage walled() {
  Stage stage;
  stage.stabiliser.method = Stabiliser::kLocalWall;
  return stage;
}

// A torque that the host has limited is not the wall's force any more: the digit's walls are withheld, and no
// other digit's.
TEST(ForceStage, WallsOfADigitWhoseTorqueWasLimitedAreWithheld) {
  for (const bool rate : {false, true}) {
    Stage stage = walled();
    stage.limits.joint_torque_enabled = !rate;
    stage.limits.joint_torque = 0.2;
    stage.limits.torque_rate_enabled = rate;
    stage.press(kDistal, 8e-3);                        // 4 N: 0.3 Nm
    stage.press(kProximal, 0.2e-3);                    // of the same digit
    stage.press(kDistal, 0.2e-3, Vec3::UnitY(), 3);    // 0.1 N: 7.5 mNm on the ring finger
    stage.press(kProximal, 0.2e-3, Vec3::UnitY(), 2);  // of the next digit: 1 mNm
    stage.tick();
    EXPECT_FALSE(stage.wall(kDistal).active);
    EXPECT_FALSE(stage.wall(kProximal).active);
    EXPECT_TRUE(stage.wall(kDistal, 3).active);
    EXPECT_TRUE(stage.wall(kProximal, 2).active);
    stage.press(kDistal, 0.2e-3);
    stage.ticks(20);
    EXPECT_TRUE(stage.wall(kDistal).active) << "and come back with the torque";
  }
}

// Long after the last contact of a digit none of its segments has a wall any more, also where another
// stabiliser has taken over meanwhile.
TEST(ForceStage, ADigitThatTouchesNothingHasNoWall) {
  for (int i = 0; i < 2 * kSegmentsPerDigit; ++i) {
    const int k = i / 2;
    Stage stage = walled();
    stage.press(k, 0.2e-3);
    stage.tick();
    ASSERT_TRUE(stage.wall(k).active) << k;
    stage.leave(k);
    if (i % 2 == 1) stage.stabiliser.method = Stabiliser::kSmoothing;
    stage.ticks(500);
    EXPECT_FALSE(stage.wall(k).active) << k;
    EXPECT_EQ(stage.wall(k).stiffness, 0.0) << k;
    EXPECT_TRUE(stage.state.resting[idx(test::kIndex)]) << k;
  }
}

// By hand: 500 N/m at 2 mm; lever arms of the point 75 mm from the knuckle, 35 and 10 mm from the other
// joints; no force along +Y turns abduction. Without caps f_max is what no device renders.
TEST(ForceStage, AWallIsTheContactAsTheControllerNeedsIt) {
  Stage stage = walled();
  stage.press(kDistal, 2e-3);
  stage.tick();
  const LocalWall& wall = stage.wall(kDistal);
  ASSERT_TRUE(wall.active);
  EXPECT_NEAR(wall.d_ref, 2e-3, 1e-15);
  EXPECT_EQ(wall.stiffness, 500.0);
  EXPECT_NEAR(wall.host_force, 1.0, 1e-12);
  EXPECT_EQ(wall.force_max, 1e6);
  EXPECT_NEAR(wall.g[0], -0.075, 1e-12);
  EXPECT_NEAR(wall.g[1], 0.0, 1e-12);
  EXPECT_NEAR(wall.g[2], -0.035, 1e-12);
  EXPECT_NEAR(wall.g[3], -0.010, 1e-12);
}

// A contact whose depth begins 0.3 mm further in: so does its wall.
TEST(ForceStage, AWallThatIsNotReachedYetBeginsWhereItsDepthDoes) {
  Stage stage = walled();
  stage.press(kDistal, -0.3e-3);
  stage.tick();
  ASSERT_TRUE(stage.wall(kDistal).active);
  EXPECT_NEAR(stage.wall(kDistal).d_ref, -0.3e-3, 1e-15);
  EXPECT_EQ(stage.wall(kDistal).stiffness, 500.0);
  EXPECT_EQ(stage.wall(kDistal).host_force, 0.0);
}

// Half a newton a metre is a stiffness. With none there is no wall, deep or not, and no number of it is left.
TEST(ForceStage, AWallNeedsAStiffnessHoweverSmall) {
  Stage stage = walled();
  stage.law.stiffness = 0.5;
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_TRUE(stage.wall(kDistal).active);
  EXPECT_EQ(stage.wall(kDistal).stiffness, 0.5);
  stage.law.stiffness = 0.0;
  for (const bool capped : {false, true}) {
    stage.limits.fingertip_force_enabled = capped;
    for (const double depth : {2e-3, -0.3e-3}) {
      stage.press(kDistal, depth);
      stage.tick();
      EXPECT_FALSE(stage.wall(kDistal).active) << depth;
      EXPECT_EQ(stage.wall(kDistal).d_ref, 0.0) << depth;
      EXPECT_EQ(stage.wall(kDistal).force_max, 0.0) << depth << " " << capped;
      EXPECT_FALSE(stage.state.remembered[idx(segment_index(test::kIndex, kDistal))].kept) << depth;
    }
  }
}

// What the host does not push, the controller does not either.
TEST(ForceStage, ASilentContactAndAStaleHandHaveNoWall) {
  Stage stage = walled();
  stage.press(kDistal, 2e-3).silent = true;
  stage.tick();
  EXPECT_FALSE(stage.wall(kDistal).active);
  stage.press(kDistal, 2e-3).silent = false;
  stage.tick();
  EXPECT_TRUE(stage.wall(kDistal).active);
  stage.stale = true;
  stage.tick();
  EXPECT_FALSE(stage.wall(kDistal).active);
}

// A law with a slope of its own: Duffing at 2 mm is 1.4 N with 1100 N/m, so that d_ref = 1.4 / 1100 m.
TEST(ForceStage, AWallsReferenceDepthIsTheLawsForceOverItsSlope) {
  Stage stage = walled();
  stage.law = {.law = ForceLaw::kDuffing, .stiffness = 500.0, .cubic = 5e7};
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).stiffness, 1100.0, 1e-9);
  EXPECT_NEAR(stage.wall(kDistal).d_ref, 1.4 / 1100.0, 1e-12);
}

// 0.2 Nm over 75 mm are 2.667 N, whichever way the wall turns the joint.
TEST(ForceStage, AWallsLargestForceKeepsTheTorqueLimit) {
  for (const double sign : {1.0, -1.0}) {
    Stage stage = walled();
    stage.limits.joint_torque_enabled = true;
    stage.limits.joint_torque = 0.2;
    stage.press(kDistal, 1e-3, sign * Vec3::UnitY());
    stage.tick();
    ASSERT_TRUE(stage.wall(kDistal).active);
    EXPECT_NEAR(stage.wall(kDistal).force_max, 0.2 / 0.075, 1e-9);
    stage.limits.joint_torque = 0.5;
    stage.limits.fingertip_force_enabled = true;
    stage.limits.fingertip_force = 4.0;
    stage.tick();
    EXPECT_NEAR(stage.wall(kDistal).force_max, 4.0, 1e-12)
        << "4 N are 0.3 Nm: the fingertip cap is the smaller";
  }
}

// Two walls on opposite sides of the finger may both be at their largest, or one of them: at the knuckle 75
// mm and 10 mm, so that 0.085 m f_max is at most 0.2 Nm where both are equal.
TEST(ForceStage, TheWallsOfADigitTogetherKeepTheTorqueLimit) {
  Stage stage = walled();
  stage.limits.fingertip_force_enabled = true;
  stage.limits.fingertip_force = 5.0;
  stage.limits.joint_torque_enabled = true;
  stage.limits.joint_torque = 0.2;
  stage.press(kDistal, 0.2e-3);
  stage.press(kProximal, 0.2e-3, -Vec3::UnitY());
  stage.tick();
  ASSERT_TRUE(stage.wall(kDistal).active && stage.wall(kProximal).active);
  for (std::size_t i = 0; i < kJointsPerDigit; ++i) {
    const double most = std::abs(stage.wall(kDistal).g[i]) * stage.wall(kDistal).force_max +
                        std::abs(stage.wall(kProximal).g[i]) * stage.wall(kProximal).force_max;
    EXPECT_LE(most, 0.2 + 1e-12) << i;
    if (i == 0) {
      EXPECT_NEAR(most, 0.2, 1e-12) << "and use it";
    }
  }
}

// The cap of 5 N holds for any forces between 0 and f_max, each combination tried. Parallel normals with 1 N
// and 0.5 N of the host: 3.5 N of room for both, in proportion to each one's own 4 and 4.5 N.
TEST(ForceStage, TheWallsOfADigitTogetherKeepTheFingertipCap) {
  for (const double turn : {0.0, 0.4, 1.2, 2.0, 3.1}) {
    Stage stage = walled();
    stage.limits.fingertip_force_enabled = true;
    stage.press(kDistal, 2e-3);
    stage.press(kProximal, 1e-3, Vec3(std::sin(turn), std::cos(turn), 0.0));
    stage.press(1, 4e-3, Vec3(-std::sin(0.5 * turn), std::cos(0.5 * turn), 0.0));
    stage.tick();
    double largest = 0.0;
    for (unsigned subset = 1; subset < 8; ++subset) {
      for (int step = 0; step <= 10; ++step) {
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < kSegmentsPerDigit; ++k) {
          if ((subset >> k & 1U) == 0U) continue;
          const double share = k == 0 ? 0.1 * step : 1.0;
          sum += share * stage.wall(k).force_max *
                 stage.state.segment[idx(segment_index(test::kIndex, k))].normal;
        }
        largest = std::max(largest, sum.norm());
      }
    }
    EXPECT_LE(largest, 5.0 + 1e-9) << turn;
    EXPECT_GT(largest, 4.9) << turn << ": and use it";
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      EXPECT_GE(stage.wall(k).force_max, stage.wall(k).host_force - 1e-12) << "at least what the host sends";
    }
  }
  Stage stage = walled();
  stage.limits.fingertip_force_enabled = true;
  stage.press(kDistal, 2e-3);
  stage.press(kProximal, 1e-3);
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).force_max, 1.0 + 3.5 * 4.0 / 8.5, 1e-9);
  EXPECT_NEAR(stage.wall(kProximal).force_max, 0.5 + 3.5 * 4.5 / 8.5, 1e-9);
}

// 6 N, capped to 5 N, and against it a wall that is not reached yet: whatever both do, the sum is within 5 N.
TEST(ForceStage, AWallAgainstOneThatIsAtTheCapHasAllOfIt) {
  Stage stage = walled();
  stage.limits.fingertip_force_enabled = true;
  stage.press(kDistal, 12e-3);
  stage.press(kProximal, -0.3e-3, -Vec3::UnitY());
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).force_max, 5.0, 1e-12);
  EXPECT_NEAR(stage.wall(kProximal).force_max, 5.0, 1e-12);
}

// 5 N of 5 N at an angle of 100 degrees to a wall that is not reached yet, whose force f leans back: with
// |5 n + f m|^2 = 25 + f^2 - 10 f cos(80 degrees) it is within 5 N up to f = 1.736 N, whatever the last bits
// of the normals are.
TEST(ForceStage, AWallBesideOneThatIsAtTheCapHasWhatLeansBack) {
  std::mt19937_64 random(1016);
  std::normal_distribution<double> number;
  const auto direction = [&] { return Vec3(number(random), number(random), number(random)).normalized(); };
  const double angle = 100.0 * kPi / 180.0;
  for (int n = 0; n < 200; ++n) {
    Stage stage = walled();
    stage.limits.fingertip_force_enabled = true;
    const Vec3 held = direction();
    const Vec3 across = held.cross(direction()).normalized();
    stage.press(kDistal, 12e-3, held);
    stage.press(kProximal, -0.3e-3, std::cos(angle) * held + std::sin(angle) * across);
    stage.tick();
    EXPECT_NEAR(stage.wall(kDistal).force_max, 5.0, 1e-9) << "seed 1016, draw " << n;
    EXPECT_NEAR(stage.wall(kProximal).force_max, 10.0 * std::cos(80.0 * kPi / 180.0), 1e-9)
        << "seed 1016, draw " << n;
  }
}

// 0.51 of either's force is along +Y, and of the rest nothing is left: 1.02 f is at most 5 N. The host sends
// 4.88 N of each, which leaves 0.022 N of room.
TEST(ForceStage, TheRoomUpToTheCapIsUsedHoweverSmallItIs) {
  Stage stage = walled();
  stage.limits.fingertip_force_enabled = true;
  const double aside = std::sqrt(1.0 - 0.51 * 0.51);
  stage.press(kDistal, 9.76e-3, Vec3(aside, 0.51, 0.0));
  stage.press(kProximal, 9.76e-3, Vec3(-aside, 0.51, 0.0));
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).force_max, 5.0 / 1.02, 1e-9);
  EXPECT_NEAR(stage.wall(kProximal).force_max, 5.0 / 1.02, 1e-9);
}

// 4 N, 4 N and, against them, 4 N: the sum is within 5 N, but without the third it would be 8 N. So no wall
// may reach what the host sends: 5/8 of 4 N each.
TEST(ForceStage, WallsMayNotReachTheHostsForceWhereSomeOfThemAloneWouldBreakTheCap) {
  Stage stage = walled();
  stage.limits.fingertip_force_enabled = true;
  stage.press(kProximal, 8e-3);
  stage.press(1, 8e-3, -Vec3::UnitY());
  stage.press(kDistal, 8e-3);
  stage.tick();
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    EXPECT_NEAR(stage.wall(k).host_force, 4.0, 1e-12) << k;
    EXPECT_NEAR(stage.wall(k).force_max, 2.5, 1e-12) << k;
  }
}

// After an oscillation the law is halved: 250 N/m, 0.5 N at 2 mm, and the wall with it.
TEST(ForceStage, AWallHasTheHalvedStiffness) {
  Stage stage = walled();
  for (int n = 0; n < 50; ++n) stage.state.stiffness_factor.advance(true, kTick);
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 0.5, 1e-12);
  EXPECT_NEAR(stage.wall(kDistal).stiffness, 250.0, 1e-9);
  EXPECT_NEAR(stage.wall(kDistal).d_ref, 2e-3, 1e-15);
}

/// A wall at 2 mm whose contact has let go, `moved` from where the finger was.
Stage left_by(const Vec3& moved, int k = kDistal) {
  Stage stage = walled();
  stage.press(k, 2e-3);
  stage.tick();
  stage.leave(k);
  stage.move_hcp(moved);
  stage.tick();
  return stage;
}

// Kept while the finger is 0 to 10 mm above the plane and at most 3 mm beside its place.
TEST(ForceStage, AWallThatWasLeftIsKeptNearItsPlaceAtTheFingersHeight) {
  const Stage above = left_by({0.0, 4e-3, 0.0});
  ASSERT_TRUE(above.wall(kDistal).active);
  EXPECT_NEAR(above.wall(kDistal).d_ref, -4e-3, 1e-12);
  EXPECT_EQ(above.wall(kDistal).stiffness, 500.0);
  EXPECT_EQ(above.wall(kDistal).host_force, 0.0);
  EXPECT_TRUE(left_by({0.0, 9.9e-3, 0.0}).wall(kDistal).active);
  EXPECT_FALSE(left_by({0.0, 10.1e-3, 0.0}).wall(kDistal).active);
  EXPECT_FALSE(left_by({0.0, -0.1e-3, 0.0}).wall(kDistal).active)
      << "below: the object is not there any more";
  EXPECT_TRUE(left_by(Vec3::Zero()).wall(kDistal).active) << "on the plane itself";
  for (const Vec3& side : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, -1.0), Vec3(-0.6, 0.0, 0.8)}) {
    EXPECT_TRUE(left_by(Vec3(0.0, 4e-3, 0.0) + 2.9e-3 * side).wall(kDistal).active);
    EXPECT_FALSE(left_by(Vec3(0.0, 4e-3, 0.0) + 3.1e-3 * side).wall(kDistal).active);
  }
}

// Its plane is where the shown finger stopped: one that was 2 mm deep and went 3 mm up is 1 mm above it.
TEST(ForceStage, AWallThatWasLeftStaysWhereTheShownFingerStopped) {
  Stage stage = walled();
  stage.press(kDistal, 2e-3);
  stage.tick();
  stage.move_hcp({0.0, -2e-3, 0.0});
  stage.press(kDistal, 2e-3);
  stage.tick();
  stage.leave(kDistal);
  stage.move_hcp({0.0, 3e-3, 0.0});
  stage.tick();
  ASSERT_TRUE(stage.wall(kDistal).active);
  EXPECT_NEAR(stage.wall(kDistal).d_ref, -1e-3, 1e-12);
}

// Also where it is the only thing that the digit has left: one tick later nothing is sent any more.
TEST(ForceStage, AWallThatWasLeftIsKeptForEachSegment) {
  for (const int k : {kProximal, 1, kDistal}) {
    Stage stage = left_by({0.0, 4e-3, 0.0}, k);
    stage.tick();
    EXPECT_TRUE(stage.wall(k).active) << k;
    EXPECT_NEAR(stage.wall(k).d_ref, -4e-3, 1e-12) << k;
  }
}

TEST(ForceStage, AWallThatWasLeftIsKeptForAQuarterOfASecond) {
  Stage stage = left_by({0.0, 1e-3, 0.0});
  stage.ticks(48);
  EXPECT_TRUE(stage.wall(kDistal).active) << "0.245 s";
  stage.ticks(2);
  EXPECT_FALSE(stage.wall(kDistal).active) << "0.255 s";
}

// 10 mm above, 3 mm aside and 0.25 s after, each exactly: two ticks of 0.125 s.
TEST(ForceStage, AWallThatWasLeftIsKeptAtItsBoundsThemselves) {
  for (const Vec3& place : {Vec3(0.0, 10e-3, 0.0), Vec3(3e-3, 0.0, 0.0), Vec3(0.0, 0.0, -3e-3)}) {
    Stage stage = walled();
    stage.period = 0.125;
    ContactRecord& record = stage.press(kDistal, 2e-3);
    record.p_S = Vec3::Zero();
    record.p_gdp = Vec3::Zero();
    stage.tick();
    stage.leave(kDistal);
    stage.hcp.digit[idx(test::kIndex)].segment[idx(kDistal)].p = place;
    for (int n = 1; n <= 3; ++n) {
      stage.tick();
      EXPECT_EQ(stage.wall(kDistal).active, n <= 2) << n << ": " << place.transpose();
    }
  }
}

// The wall of the index finger's first segment, while the thumb, the digit before, rests, and then leaves a
// wall that it forgets at once: it is below that.
TEST(ForceStage, AWallIsNotThatOfTheDigitBefore) {
  Stage stage = walled();
  stage.press(kProximal, 2e-3);
  stage.ticks(2);
  EXPECT_TRUE(stage.state.resting[idx(kThumbBefore)]);
  stage.press(kDistal, 0.2e-3, Vec3::UnitY(), kThumbBefore);
  stage.tick();
  EXPECT_TRUE(stage.wall(kDistal, kThumbBefore).active);
  stage.leave(kProximal);
  stage.leave(kDistal, kThumbBefore);
  stage.move_hcp({0.0, 1e-3, 0.0});
  for (Pose& segment : stage.hcp.digit[idx(kThumbBefore)].segment) segment.p.y() -= 1e-3;
  stage.ticks(3);
  EXPECT_TRUE(stage.state.resting[idx(kThumbBefore)]);
  EXPECT_TRUE(stage.wall(kProximal).active);
}

// The method is exchanged while the finger touches, and the finger leaves under the other one: what was known
// of the wall is forgotten with the contact.
TEST(ForceStage, AWallIsForgottenWhereTheFingerLeavesUnderAnotherMethod) {
  Stage stage = walled();
  stage.press(kDistal, 2e-3);
  stage.tick();
  ASSERT_TRUE(stage.wall(kDistal).active);
  stage.stabiliser.method = Stabiliser::kNone;
  stage.tick();
  stage.leave(kDistal);
  stage.ticks(2);
  stage.stabiliser.method = Stabiliser::kLocalWall;
  stage.tick();
  EXPECT_FALSE(stage.wall(kDistal).active);
}

// Once the measured hand is not known any more, no wall is known either, also after samples come again.
TEST(ForceStage, AStaleHandForgetsAWallThatWasLeft) {
  Stage stage = left_by({0.0, 1e-3, 0.0});
  ASSERT_TRUE(stage.wall(kDistal).active);
  stage.stale = true;
  stage.tick();
  EXPECT_FALSE(stage.wall(kDistal).active);
  stage.stale = false;
  stage.tick();
  EXPECT_FALSE(stage.wall(kDistal).active);
}

}  // namespace
}  // namespace phalanx
