// SPDX-License-Identifier: Apache-2.0
// A contact for the device's own controller.
#include <gmock/gmock.h>

#include <array>

#include "phalanx/force/local_wall.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/simple_hand.h"
#include "support/stabilised_hands.h"

namespace phalanx {
namespace {

using test::at;
using test::ball_model;
using test::floor_model;
using test::grasp;
using test::index_angles;
using test::index_segment;
using test::kIndex;
using test::moved;
using test::Runner;

// At the angles that made them the walls are the host's forces and torques.
TEST(LocalWall, IsTheHostsCommandAtItsReference) {
  for (const ForceLaw law : {ForceLaw::kHooke, ForceLaw::kHuntCrossley, ForceLaw::kDuffing}) {
    test::Setup model = ball_model(Stabiliser::kLocalWall);
    test::turn_limits_off(model);
    model.parameters.stabiliser.method = Stabiliser::kLocalWall;
    model.parameters.force.law = law;
    Runner hand(model);
    int walls = 0;
    for (int n = 0; n <= 150; ++n) {
      const Snapshot& now = hand.tick(grasp(n));
      const DigitAngles q_ref = digit_angles(now.hcp_angle, kIndex);
      std::array<double, kJointsPerDigit> torque{};
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        const LocalWall& wall = now.wall[static_cast<std::size_t>(segment_index(kIndex, k))];
        const SegmentSnapshot& segment = index_segment(now, k);
        const double force = local_wall_force(wall, q_ref, q_ref);
        EXPECT_NEAR(force, segment.force, 1e-9 * (1.0 + segment.force)) << "tick " << n;
        EXPECT_EQ(wall.host_force, segment.force);
        for (std::size_t i = 0; i < torque.size(); ++i) torque[i] += wall.g[i] * force;
        walls += wall.active ? 1 : 0;
      }
      for (int i = 0; i < kJointsPerDigit; ++i)
        EXPECT_NEAR(torque[static_cast<std::size_t>(i)], test::index_torque(now, i), 1e-9) << "tick " << n;
      EXPECT_EQ(now.wall_valid_for, 14e-3);
    }
    EXPECT_GT(walls, 100);
  }
}

// Between two steps it is what the host would say: the finger presses the floor 0.01 rad deeper than it
// rests on it, and the walls of a step give the law's force of the next, one hundredth of that deeper, to 2 %
// of the change. Leaving by more than the depth gives nothing.
TEST(LocalWall, FollowsTheLawBetweenTwoSteps) {
  test::Setup model = floor_model(Stabiliser::kLocalWall);
  test::turn_limits_off(model);
  model.parameters.stabiliser.method = Stabiliser::kLocalWall;
  Runner hand(model);
  double first = 0.0;
  for (int n = 0; n <= 2000 && !index_segment(hand.now(), 2).contact; ++n)
    hand.tick(index_angles(first = 5e-4 * n));
  hand.move(index_angles(first + 0.01), 20);
  const Snapshot before = hand.now();
  const LocalWall wall = before.wall[static_cast<std::size_t>(segment_index(kIndex, 2))];
  ASSERT_TRUE(wall.active);
  const Snapshot after = hand.tick(index_angles(first + 0.0101));
  const DigitAngles q_ref = digit_angles(before.hcp_angle, kIndex);
  const double change = index_segment(after, 2).force - index_segment(before, 2).force;
  ASSERT_GT(change, 1e-3);
  const double predicted = local_wall_force(wall, digit_angles(after.hcp_angle, kIndex), q_ref);
  EXPECT_NEAR(predicted - index_segment(before, 2).force, change, 0.02 * change);
  DigitAngles away = q_ref;
  away[0] -= 0.1;
  EXPECT_EQ(local_wall_force(wall, away, q_ref), 0.0);
}

TEST(LocalWall, IsNotThereUnderAnotherMethodOrWithoutContact) {
  for (const Stabiliser method : {Stabiliser::kSmoothing, Stabiliser::kLocalWall}) {
    const test::Setup model = ball_model(method);
    Runner hand(model);
    hand.tick(grasp(0));
    for (const LocalWall& wall : hand.now().wall) EXPECT_FALSE(wall.active);
    hand.move(grasp(150), 100);
    int active = 0;
    for (const LocalWall& wall : hand.now().wall) active += wall.active ? 1 : 0;
    EXPECT_EQ(active > 0, method == Stabiliser::kLocalWall);
    hand.move(grasp(0), 100);
    hand.move(grasp(0), 60);  // longer than a wall that was left is kept
    for (const LocalWall& wall : hand.now().wall) EXPECT_FALSE(wall.active);
  }
}

// A finger that has just left meets the same plane when it comes back: as high above it as it is, with no
// force.
TEST(LocalWall, IsKeptForAWhileAfterTheContactLetsGo) {
  const test::Setup model = floor_model(Stabiliser::kLocalWall);
  Runner hand(model);
  const std::size_t tip = static_cast<std::size_t>(segment_index(kIndex, 2));
  hand.move(index_angles(0.28), 60);
  ASSERT_TRUE(hand.now().segment[tip].contact);
  const double stiffness = hand.now().wall[tip].stiffness;
  for (int n = 0; n < 40 && hand.now().segment[tip].contact; ++n) hand.tick(index_angles(0.28 - 0.01 * n));
  ASSERT_FALSE(hand.now().segment[tip].contact);
  const LocalWall left = hand.now().wall[tip];
  ASSERT_TRUE(left.active);
  EXPECT_LE(left.d_ref, 0.0);
  EXPECT_EQ(left.stiffness, stiffness);
  EXPECT_EQ(left.host_force, 0.0);
  const DigitAngles here = digit_angles(hand.now().hcp_angle, kIndex);
  DigitAngles back = here;
  back[0] += 0.05;  // flexes into the plane again
  EXPECT_EQ(local_wall_force(left, here, here), 0.0);
  EXPECT_GT(local_wall_force(left, back, here), 0.1);
  for (int n = 0; n < 51; ++n) hand.tick(hand.now().hcp_angle);  // 0.25 s
  EXPECT_FALSE(hand.now().wall[tip].active);
}

}  // namespace
}  // namespace phalanx
