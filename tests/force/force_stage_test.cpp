// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/force_stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "force/force_stage_fixture.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_law.h"
#include "support/all_stabilisers.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using Stage = test::ForceStageFixture;
using test::kDistal;
using test::kProximal;
using test::kThumb;
using test::kTick;

const double kGain = 1.0 - std::exp(-2.0 * kPi * 30.0 * kTick);  ///< of a low-pass of 30 Hz: 0.61034

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
  stage.parameters.force = {
      .law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 2.0, .velocity_lowpass_hz = 1e6};
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
  stage.parameters.force.velocity_lowpass_hz = 30.0;
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
  stage.parameters.force = {
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
  stage.parameters.force = {
      .law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 2.0, .velocity_lowpass_hz = 1e6};
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
  stage.parameters.force = {
      .law = ForceLaw::kKelvinVoigt, .stiffness = 500.0, .damping = 2.0, .velocity_lowpass_hz = 1e6};
  stage.press(kDistal, 2e-3, Vec3::UnitZ());
  stage.tick();
  EXPECT_NEAR(stage.sent(kDistal), 1.0, 1e-12);
}

// A contact without depth sends nothing; when it goes, so does its speed, whichever segment's it is.
TEST(ForceStage, AContactThatWasNeverFeltLeavesNothingBehind) {
  for (const int k : {kProximal, 1, kDistal}) {
    Stage stage;
    stage.parameters.force.velocity_lowpass_hz = 30.0;
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
    stage.parameters.force.velocity_lowpass_hz = 30.0;
    stage.parameters.stabiliser = {.method = method, .damping = 4.0, .passivity_damping_max = 50.0};
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
  stage.parameters.rate_hz = 1000.0;
  stage.parameters.stabiliser.method = Stabiliser::kSmoothing;
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
      stage.parameters.stabiliser.method = method;
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
  overflow.parameters.limits.fingertip_force_enabled = true;
  overflow.parameters.force = {.law = ForceLaw::kDuffing, .stiffness = 500.0, .cubic = 5e7};
  overflow.press(kDistal, 1e110);
  EXPECT_TRUE(has(overflow.tick(), Status::kCommandNotFinite));
  EXPECT_EQ(overflow.sent(kDistal), 0.0);
  EXPECT_EQ(overflow.torque(0), 0.0);

  for (const bool limited : {false, true}) {
    Stage nowhere;
    nowhere.parameters.limits.joint_torque_enabled = nowhere.parameters.limits.torque_rate_enabled = limited;
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
  stage.parameters.stabiliser.method = Stabiliser::kDirection;
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
  stage.parameters.stabiliser.method = Stabiliser::kSmoothing;
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
  stage.parameters.stabiliser.method = Stabiliser::kSmoothing;
  stage.press(kDistal, 0.1e-3, Vec3::UnitY(), kThumb);
  stage.press(kProximal, 2e-3);
  stage.ticks(2);
  EXPECT_NEAR(stage.torque(0, kThumb), -0.075 * 0.05, 1e-12);
  EXPECT_NEAR(stage.torque(0), -0.010 * 0.2, 1e-12);
  stage.leave(kDistal, kThumb);
  stage.ticks(3);
  EXPECT_TRUE(stage.state.resting[idx(kThumb)]);
  EXPECT_NEAR(stage.sent(kProximal), 0.5, 1e-12);
}

// ---- limits ----

// 4 N on each of two segments along the same normal and a cap of 5 N on the digit: 2.5 N each, and it is
// said.
TEST(ForceStage, TheDigitsSumIsCappedAndSaid) {
  Stage stage;
  stage.parameters.limits.fingertip_force_enabled = true;
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
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.parameters.stabiliser.method = Stabiliser::kSmoothing;
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
    stage.parameters.limits.fingertip_force_enabled = true;
    stage.press(kDistal, 10e-3 + beyond / 500.0);
    EXPECT_EQ(has(stage.tick(), Status::kForceLimited), beyond > 1e-6) << beyond;
    EXPECT_NEAR(stage.sent(kDistal), 5.0, 1e-12) << beyond;
  }
  // 1 um into 2 N/m are 2 uN, of which a cap of 1 uN takes one.
  Stage stage;
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.parameters.limits.fingertip_force = 1e-6;
  stage.parameters.force.stiffness = 2.0;
  stage.press(kDistal, 1e-6);
  EXPECT_FALSE(has(stage.tick(), Status::kForceLimited)) << "a micronewton itself";
  EXPECT_EQ(stage.sent(kDistal), 1e-6);
}

// 12 mm into 500 N/m are 6 N, also beside a damper where no cap is on. With one of 5 N, 10 mm are 5 N, which
// the cap leaves alone.
TEST(ForceStage, ACapThatIsOffOrJustReachedLeavesADampedContactAlone) {
  Stage stage;
  stage.parameters.stabiliser = {.method = Stabiliser::kKelvinVoigt, .damping = 4.0};
  stage.press(kDistal, 12e-3);
  EXPECT_EQ(stage.tick(), Status::kOk);
  EXPECT_NEAR(stage.sent(kDistal), 6.0, 1e-12);
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.press(kDistal, 10e-3);
  EXPECT_EQ(stage.tick(), Status::kOk);
  EXPECT_EQ(stage.sent(kDistal), 5.0);
}

// A damper may bring a contact above the cap; smoothing keeps below the law by itself.
TEST(ForceStage, AMethodThatAddsToTheLawIsCappedOnEachContactAgain) {
  Stage stage;
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.parameters.limits.fingertip_force = 1.2;
  stage.parameters.force.velocity_lowpass_hz = 1e6;
  stage.parameters.stabiliser = {.method = Stabiliser::kKelvinVoigt, .damping = 4.0};
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
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.parameters.force.velocity_lowpass_hz = 1e6;
  stage.parameters.stabiliser = {.method = Stabiliser::kKelvinVoigt, .damping = 4.0};
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
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.parameters.limits.fingertip_force = 1.0;
  stage.parameters.stabiliser = {
      .method = Stabiliser::kVirtualCoupling, .coupling_stiffness = 1000.0, .coupling_damping = 4.0};
  stage.press(kDistal, 4e-3);
  stage.ticks(200);
  EXPECT_NEAR(stage.sent(kDistal), 0.8, 1e-9);
}

// 75 mm x 4 N = 0.3 Nm wanted. A limit of 0.2 Nm, and a rate of 10 Nm/s: 0.05 Nm a tick, down and up alike.
TEST(ForceStage, TorqueIsLimitedAndRateLimitedBothWaysAndEachIsSaid) {
  Stage stage;
  stage.parameters.limits.joint_torque_enabled = true;
  stage.parameters.limits.joint_torque = 0.2;
  stage.press(kDistal, 8e-3);
  EXPECT_TRUE(has(stage.tick(), Status::kTorqueLimited));
  EXPECT_NEAR(stage.torque(0), -0.2, 1e-15);
  stage.press(kDistal, 1e-3);
  EXPECT_EQ(stage.tick(), Status::kOk);
  stage.parameters.limits.torque_rate_enabled = true;
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
    stage.parameters.oscillation.swing = swing;
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
  stage.press(kDistal, 2e-3, Vec3::UnitY(), kThumb);
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
  stage.parameters.oscillation.reaction = OscillationReaction::kHalve;
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

}  // namespace
}  // namespace phalanx
