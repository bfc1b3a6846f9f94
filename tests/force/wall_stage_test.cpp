// SPDX-License-Identifier: Apache-2.0
#include "force/wall_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "force/force_stage_fixture.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

using Stage = test::ForceStageFixture;
using test::kDistal;
using test::kProximal;
using test::kThumb;
using test::kTick;

Stage walled() {
  Stage stage;
  stage.parameters.stabiliser.method = Stabiliser::kLocalWall;
  return stage;
}

// A torque that the host has limited is not the wall's force any more: the digit's walls are withheld, and no
// other digit's.
TEST(WallStage, WallsOfADigitWhoseTorqueWasLimitedAreWithheld) {
  for (const bool rate : {false, true}) {
    Stage stage = walled();
    stage.parameters.limits.joint_torque_enabled = !rate;
    stage.parameters.limits.joint_torque = 0.2;
    stage.parameters.limits.torque_rate_enabled = rate;
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
TEST(WallStage, ADigitThatTouchesNothingHasNoWall) {
  for (int i = 0; i < 2 * kSegmentsPerDigit; ++i) {
    const int k = i / 2;
    Stage stage = walled();
    stage.press(k, 0.2e-3);
    stage.tick();
    ASSERT_TRUE(stage.wall(k).active) << k;
    stage.leave(k);
    if (i % 2 == 1) stage.parameters.stabiliser.method = Stabiliser::kSmoothing;
    stage.ticks(500);
    EXPECT_FALSE(stage.wall(k).active) << k;
    EXPECT_EQ(stage.wall(k).stiffness, 0.0) << k;
    EXPECT_TRUE(stage.state.resting[idx(test::kIndex)]) << k;
  }
}

// By hand: 500 N/m at 2 mm; lever arms of the point 75 mm from the knuckle, 35 and 10 mm from the other
// joints; no force along +Y turns abduction. Without caps f_max is what no device renders.
TEST(WallStage, AWallIsTheContactAsTheControllerNeedsIt) {
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
TEST(WallStage, AWallThatIsNotReachedYetBeginsWhereItsDepthDoes) {
  Stage stage = walled();
  stage.press(kDistal, -0.3e-3);
  stage.tick();
  ASSERT_TRUE(stage.wall(kDistal).active);
  EXPECT_NEAR(stage.wall(kDistal).d_ref, -0.3e-3, 1e-15);
  EXPECT_EQ(stage.wall(kDistal).stiffness, 500.0);
  EXPECT_EQ(stage.wall(kDistal).host_force, 0.0);
}

// Half a newton a metre is a stiffness. With none there is no wall, deep or not, and no number of it is left.
TEST(WallStage, AWallNeedsAStiffnessHoweverSmall) {
  Stage stage = walled();
  stage.parameters.force.stiffness = 0.5;
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_TRUE(stage.wall(kDistal).active);
  EXPECT_EQ(stage.wall(kDistal).stiffness, 0.5);
  stage.parameters.force.stiffness = 0.0;
  for (const bool capped : {false, true}) {
    stage.parameters.limits.fingertip_force_enabled = capped;
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
TEST(WallStage, ASilentContactAndAStaleHandHaveNoWall) {
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
TEST(WallStage, AWallsReferenceDepthIsTheLawsForceOverItsSlope) {
  Stage stage = walled();
  stage.parameters.force = {.law = ForceLaw::kDuffing, .stiffness = 500.0, .cubic = 5e7};
  stage.press(kDistal, 2e-3);
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).stiffness, 1100.0, 1e-9);
  EXPECT_NEAR(stage.wall(kDistal).d_ref, 1.4 / 1100.0, 1e-12);
}

// 0.2 Nm over 75 mm are 2.667 N, whichever way the wall turns the joint.
TEST(WallStage, AWallsLargestForceKeepsTheTorqueLimit) {
  for (const double sign : {1.0, -1.0}) {
    Stage stage = walled();
    stage.parameters.limits.joint_torque_enabled = true;
    stage.parameters.limits.joint_torque = 0.2;
    stage.press(kDistal, 1e-3, sign * Vec3::UnitY());
    stage.tick();
    ASSERT_TRUE(stage.wall(kDistal).active);
    EXPECT_NEAR(stage.wall(kDistal).force_max, 0.2 / 0.075, 1e-9);
    stage.parameters.limits.joint_torque = 0.5;
    stage.parameters.limits.fingertip_force_enabled = true;
    stage.parameters.limits.fingertip_force = 4.0;
    stage.tick();
    EXPECT_NEAR(stage.wall(kDistal).force_max, 4.0, 1e-12)
        << "4 N are 0.3 Nm: the fingertip cap is the smaller";
  }
}

// Two walls on opposite sides of the finger may both be at their largest, or one of them: at the knuckle 75
// mm and 10 mm, so that 0.085 m f_max is at most 0.2 Nm where both are equal.
TEST(WallStage, TheWallsOfADigitTogetherKeepTheTorqueLimit) {
  Stage stage = walled();
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.parameters.limits.fingertip_force = 5.0;
  stage.parameters.limits.joint_torque_enabled = true;
  stage.parameters.limits.joint_torque = 0.2;
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
TEST(WallStage, TheWallsOfADigitTogetherKeepTheFingertipCap) {
  for (const double turn : {0.0, 0.4, 1.2, 2.0, 3.1}) {
    Stage stage = walled();
    stage.parameters.limits.fingertip_force_enabled = true;
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
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.press(kDistal, 2e-3);
  stage.press(kProximal, 1e-3);
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).force_max, 1.0 + 3.5 * 4.0 / 8.5, 1e-9);
  EXPECT_NEAR(stage.wall(kProximal).force_max, 0.5 + 3.5 * 4.5 / 8.5, 1e-9);
}

// 6 N, capped to 5 N, and against it a wall that is not reached yet: whatever both do, the sum is within 5 N.
TEST(WallStage, AWallAgainstOneThatIsAtTheCapHasAllOfIt) {
  Stage stage = walled();
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.press(kDistal, 12e-3);
  stage.press(kProximal, -0.3e-3, -Vec3::UnitY());
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).force_max, 5.0, 1e-12);
  EXPECT_NEAR(stage.wall(kProximal).force_max, 5.0, 1e-12);
}

// 5 N of 5 N at an angle of 100 degrees to a wall that is not reached yet, whose force f leans back: with
// |5 n + f m|^2 = 25 + f^2 - 10 f cos(80 degrees) it is within 5 N up to f = 1.736 N, whatever the last bits
// of the normals are.
TEST(WallStage, AWallBesideOneThatIsAtTheCapHasWhatLeansBack) {
  std::mt19937_64 random(1016);
  std::normal_distribution<double> number;
  const auto direction = [&] { return Vec3(number(random), number(random), number(random)).normalized(); };
  const double angle = 100.0 * kPi / 180.0;
  for (int n = 0; n < 200; ++n) {
    Stage stage = walled();
    stage.parameters.limits.fingertip_force_enabled = true;
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
TEST(WallStage, TheRoomUpToTheCapIsUsedHoweverSmallItIs) {
  Stage stage = walled();
  stage.parameters.limits.fingertip_force_enabled = true;
  const double aside = std::sqrt(1.0 - 0.51 * 0.51);
  stage.press(kDistal, 9.76e-3, Vec3(aside, 0.51, 0.0));
  stage.press(kProximal, 9.76e-3, Vec3(-aside, 0.51, 0.0));
  stage.tick();
  EXPECT_NEAR(stage.wall(kDistal).force_max, 5.0 / 1.02, 1e-9);
  EXPECT_NEAR(stage.wall(kProximal).force_max, 5.0 / 1.02, 1e-9);
}

// 4 N, 4 N and, against them, 4 N: the sum is within 5 N, but without the third it would be 8 N. So no wall
// may reach what the host sends: 5/8 of 4 N each.
TEST(WallStage, WallsMayNotReachTheHostsForceWhereSomeOfThemAloneWouldBreakTheCap) {
  Stage stage = walled();
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.press(kProximal, 8e-3);
  stage.press(1, 8e-3, -Vec3::UnitY());
  stage.press(kDistal, 8e-3);
  stage.tick();
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    EXPECT_NEAR(stage.wall(k).host_force, 4.0, 1e-12) << k;
    EXPECT_NEAR(stage.wall(k).force_max, 2.5, 1e-12) << k;
  }
}

/// The largest sum of the digit's walls, each at 0 or at its f_max. [N]
double largest_sum(const Stage& stage) {
  double largest = 0.0;
  for (unsigned subset = 1; subset < 1U << kSegmentsPerDigit; ++subset) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      if ((subset >> k & 1U) == 0U) continue;
      sum += stage.wall(k).force_max * stage.state.segment[idx(segment_index(test::kIndex, k))].normal;
    }
    largest = std::max(largest, sum.norm());
  }
  return largest;
}

// Three walls in any directions, each of them pressed with up to 10 N before the cap, at the cap exactly or
// not reached yet.
TEST(WallStage, AnyThreeWallsKeepTheFingertipCap) {
  constexpr unsigned kSeed = 1017;
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> number;
  std::uniform_real_distribution<double> deep(5e-3, 20e-3);
  for (int n = 0; n < 400; ++n) {
    Stage stage = walled();
    stage.parameters.limits.fingertip_force_enabled = true;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const auto kind = random() % 3;
      const double depth = kind == 0 ? -0.3e-3 : kind == 1 ? 10e-3 : deep(random);
      stage.press(k, depth, Vec3(number(random), number(random), number(random)).normalized());
    }
    stage.tick();
    EXPECT_LE(largest_sum(stage), 5.0 * (1.0 + 1e-9)) << "seed " << kSeed << ", draw " << n;
    EXPECT_GT(largest_sum(stage), 4.9) << "seed " << kSeed << ", draw " << n << ": and use it";
  }
}

// A contact that is not reached yet and whose direction is not a number loads no joint of the command. It is
// no wall, and the digit's other walls are as if it were not there.
TEST(WallStage, ADirectionThatIsNotANumberIsNoWall) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Stage stage = walled();
  stage.parameters.limits.fingertip_force_enabled = true;
  stage.press(kProximal, 2e-3);
  stage.press(1, -0.3e-3, Vec3(kNaN, kNaN, kNaN));
  stage.press(kDistal, 2e-3, -Vec3::UnitY());
  stage.tick();
  EXPECT_FALSE(stage.wall(1).active);
  EXPECT_EQ(stage.wall(1).force_max, 0.0);
  EXPECT_EQ(stage.wall(1).g, LocalWall{}.g);
  for (const int k : {kProximal, kDistal}) {
    EXPECT_TRUE(stage.wall(k).active) << k;
    EXPECT_NEAR(stage.wall(k).force_max, 5.0, 1e-9) << k;
  }
}

// After an oscillation the law is halved: 250 N/m, 0.5 N at 2 mm, and the wall with it.
TEST(WallStage, AWallHasTheHalvedStiffness) {
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
TEST(WallStage, AWallThatWasLeftIsKeptNearItsPlaceAtTheFingersHeight) {
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
TEST(WallStage, AWallThatWasLeftStaysWhereTheShownFingerStopped) {
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
TEST(WallStage, AWallThatWasLeftIsKeptForEachSegment) {
  for (const int k : {kProximal, 1, kDistal}) {
    Stage stage = left_by({0.0, 4e-3, 0.0}, k);
    stage.tick();
    EXPECT_TRUE(stage.wall(k).active) << k;
    EXPECT_NEAR(stage.wall(k).d_ref, -4e-3, 1e-12) << k;
  }
}

TEST(WallStage, AWallThatWasLeftIsKeptForAQuarterOfASecond) {
  Stage stage = left_by({0.0, 1e-3, 0.0});
  stage.ticks(48);
  EXPECT_TRUE(stage.wall(kDistal).active) << "0.245 s";
  stage.ticks(2);
  EXPECT_FALSE(stage.wall(kDistal).active) << "0.255 s";
}

// 10 mm above, 3 mm aside and 0.25 s after, each exactly: two ticks of 0.125 s.
TEST(WallStage, AWallThatWasLeftIsKeptAtItsBoundsThemselves) {
  for (const Vec3& place : {Vec3(0.0, 10e-3, 0.0), Vec3(3e-3, 0.0, 0.0), Vec3(0.0, 0.0, -3e-3)}) {
    Stage stage = walled();
    stage.parameters.rate_hz = 8.0;
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
TEST(WallStage, AWallIsNotThatOfTheDigitBefore) {
  Stage stage = walled();
  stage.press(kProximal, 2e-3);
  stage.ticks(2);
  EXPECT_TRUE(stage.state.resting[idx(kThumb)]);
  stage.press(kDistal, 0.2e-3, Vec3::UnitY(), kThumb);
  stage.tick();
  EXPECT_TRUE(stage.wall(kDistal, kThumb).active);
  stage.leave(kProximal);
  stage.leave(kDistal, kThumb);
  stage.move_hcp({0.0, 1e-3, 0.0});
  for (Pose& segment : stage.hcp.digit[idx(kThumb)].segment) segment.p.y() -= 1e-3;
  stage.ticks(3);
  EXPECT_TRUE(stage.state.resting[idx(kThumb)]);
  EXPECT_TRUE(stage.wall(kProximal).active);
}

// The method is exchanged while the finger touches, and the finger leaves under the other one: what was known
// of the wall is forgotten with the contact.
TEST(WallStage, AWallIsForgottenWhereTheFingerLeavesUnderAnotherMethod) {
  Stage stage = walled();
  stage.press(kDistal, 2e-3);
  stage.tick();
  ASSERT_TRUE(stage.wall(kDistal).active);
  stage.parameters.stabiliser.method = Stabiliser::kNone;
  stage.tick();
  stage.leave(kDistal);
  stage.ticks(2);
  stage.parameters.stabiliser.method = Stabiliser::kLocalWall;
  stage.tick();
  EXPECT_FALSE(stage.wall(kDistal).active);
}

// Once the measured hand is not known any more, no wall is known either, also after samples come again.
TEST(WallStage, AStaleHandForgetsAWallThatWasLeft) {
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
