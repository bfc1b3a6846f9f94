// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr double kRight = std::numbers::pi / 2.0;

TEST(Constants, SayHowManyUnitsMakeOneOfThose) {
  EXPECT_DOUBLE_EQ(kPi, 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(1000.0 * kMilli, 1.0);
  EXPECT_DOUBLE_EQ(1000.0 * kMm, 1.0);
  EXPECT_DOUBLE_EQ(180.0 * kDeg, 3.14159265358979323846);
  EXPECT_DOUBLE_EQ(3.14159265358979323846 * kRadToDeg, 180.0);
  EXPECT_TRUE(std::isinf(kInfinity) && kInfinity > 0.0);
}

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
