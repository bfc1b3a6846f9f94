// SPDX-License-Identifier: Apache-2.0
#include "phalanx/core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace phalanx {
namespace {

constexpr std::uint64_t kSeed = 1234567;
/// The first numbers of SplitMix64 for that seed, as they are published (Rosetta Code, "Pseudo-random
/// numbers/Splitmix64").
constexpr std::array<std::uint64_t, 5> kPublished = {6457827717110365317U, 3203168211198807973U,
                                                     9817491932198370423U, 4593380528125082431U,
                                                     16408922859458223821U};

// A double has 53 bits: the upper ones of 64.
TEST(Random, IsTheUpperBitsOfThePublishedNumbers) {
  Random random(kSeed);
  for (const std::uint64_t number : kPublished)
    EXPECT_EQ(random.uniform(), static_cast<double>(number / 2048U) / 9007199254740992.0);
}

TEST(Random, BetweenGoesFromTheLowerToTheHigherNumber) {
  Random random(kSeed);
  EXPECT_DOUBLE_EQ(random.between(-2.0, 3.0), -2.0 + 5.0 * 0.3500795420214081);
  EXPECT_DOUBLE_EQ(random.between(10.0, 10.5), 10.0 + 0.5 * 0.17364409667091263);
}

// Box & Muller: sqrt(-2 ln(1 - 0.350080)) cos(2 pi 0.173644), then the same of 0.532207 and 0.249008, by a
// calculator.
TEST(Random, NormalTakesTwoUniformNumbers) {
  Random random(kSeed);
  EXPECT_NEAR(random.normal(), 0.4284879007349292, 1e-12);
  EXPECT_NEAR(random.normal(), 0.0076856985150487, 1e-12);
}

}  // namespace
}  // namespace phalanx
