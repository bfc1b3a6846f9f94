// SPDX-License-Identifier: Apache-2.0
// A contact for the device's own controller.
#include <gmock/gmock.h>

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::at;
using test::index_angles;
using test::index_segment;
using test::kIndex;
using test::moved;
using test::Runner;

/// A slab 20 mm below the straight index finger.
HapticModel floor_model(Stabiliser method) {
  HapticModel model(test::simple_hand(),
                    ObjectModel(moved(make_box(Vec3(0.06, 0.02, 0.3), 12), at(0.0, -0.030, 0.0))));
  model.stabiliser.method = method;
  return model;
}
/// A ball under the proximal phalanx, which the whole finger can close around.
HapticModel ball_model(Stabiliser method) {
  HapticModel model(test::simple_hand(),
                    ObjectModel(moved(make_sphere(0.03, 2000), at(0.0, -0.028, -0.028))));
  model.stabiliser.method = method;
  return model;
}
/// Around the ball and open again, `n` from 0 to 300.
JointArray grasp(int n) {
  const double close = n <= 150 ? n / 150.0 : (300 - n) / 150.0;
  return index_angles(1.0 * close, 1.6 * close, 1.6 * close, 0.1 * close);
}

DigitJoints joints_of(const JointArray& angle, int digit) {
  DigitJoints out{};
  for (int i = 0; i < kJointsPerDigit; ++i)
    out[static_cast<std::size_t>(i)] = angle[static_cast<std::size_t>(joint_index(digit, i))];
  return out;
}

// At the angles that made them the walls are the host's forces and torques.
TEST(LocalWall, IsTheHostsCommandAtItsReference) {
  for (const ForceLaw law : {ForceLaw::kHooke, ForceLaw::kHuntCrossley, ForceLaw::kDuffing}) {
    HapticModel model = ball_model(Stabiliser::kLocalWall);
    test::turn_limits_off(model);
    model.force.law = law;
    Runner hand(model);
    int walls = 0;
    for (int n = 0; n <= 150; ++n) {
      const Snapshot& now = hand.tick(grasp(n));
      const DigitJoints q_ref = joints_of(now.hcp_angle, kIndex);
      DigitJoints torque{};
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
  HapticModel model = floor_model(Stabiliser::kLocalWall);
  test::turn_limits_off(model);
  Runner hand(model);
  double first = 0.0;
  for (int n = 0; n <= 2000 && !index_segment(hand.now(), 2).contact; ++n)
    hand.tick(index_angles(first = 5e-4 * n));
  hand.move(index_angles(first + 0.01), 20);
  const Snapshot before = hand.now();
  const LocalWall wall = before.wall[static_cast<std::size_t>(segment_index(kIndex, 2))];
  ASSERT_TRUE(wall.active);
  const Snapshot after = hand.tick(index_angles(first + 0.0101));
  const DigitJoints q_ref = joints_of(before.hcp_angle, kIndex);
  const double change = index_segment(after, 2).force - index_segment(before, 2).force;
  ASSERT_GT(change, 1e-3);
  const double predicted = local_wall_force(wall, joints_of(after.hcp_angle, kIndex), q_ref);
  EXPECT_NEAR(predicted - index_segment(before, 2).force, change, 0.02 * change);
  DigitJoints away = q_ref;
  away[0] -= 0.1;
  EXPECT_EQ(local_wall_force(wall, away, q_ref), 0.0);
}

TEST(LocalWall, IsNotThereUnderAnotherMethodOrWithoutContact) {
  for (const Stabiliser method : {Stabiliser::kSmoothing, Stabiliser::kLocalWall}) {
    const HapticModel model = ball_model(method);
    Runner hand(model);
    hand.tick(grasp(0));
    for (const LocalWall& wall : hand.now().wall) EXPECT_FALSE(wall.active);
    hand.move(grasp(150), 100);
    int active = 0;
    for (const LocalWall& wall : hand.now().wall) active += wall.active ? 1 : 0;
    EXPECT_EQ(active > 0, method == Stabiliser::kLocalWall);
    hand.move(grasp(0), 100);
    for (const LocalWall& wall : hand.now().wall) EXPECT_FALSE(wall.active);
  }
}

}  // namespace
}  // namespace phalanx
