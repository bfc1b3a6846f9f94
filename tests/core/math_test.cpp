// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/math.h"

#include <gtest/gtest.h>

#include <numbers>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr double kRight = std::numbers::pi / 2.0;

TEST(Rotation, TurnsByTheRightHand) {
  EXPECT_LT((rotation_about(Vec3::UnitZ(), kRight) * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((rotation_about(Vec3::UnitX(), kRight) * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm(), 1e-15);
}

// X turns x to y and moves by (1, 2, 3), Y turns y to z and moves by (4, 5, 6). Y takes (0, 1, 0) to (4, 5,
// 7), and X takes that to (-5, 4, 7) + (1, 2, 3).
TEST(Pose, TurnsAndThenMoves) {
  const Pose X{rotation_about(Vec3::UnitZ(), kRight), Vec3(1, 2, 3)};
  const Pose Y{rotation_about(Vec3::UnitX(), kRight), Vec3(4, 5, 6)};
  EXPECT_LT((X * Vec3(1, 0, 0) - Vec3(1, 3, 3)).norm(), 1e-14);
  EXPECT_LT((X.inverse() * Vec3(1, 3, 3) - Vec3(1, 0, 0)).norm(), 1e-14);
  const Pose both = X * Y;
  EXPECT_LT((both * Vec3(0, 1, 0) - Vec3(-4, 6, 10)).norm(), 1e-14);
  EXPECT_LT((both.p - Vec3(-4, 6, 9)).norm(), 1e-14);
  EXPECT_EQ(Pose{} * Vec3(1, 2, 3), Vec3(1, 2, 3));
}

TEST(Index, IsTheNumberItself) {
  EXPECT_EQ(idx(0), 0U);
  EXPECT_EQ(idx(7), 7U);
}

}  // namespace
}  // namespace phalanx
