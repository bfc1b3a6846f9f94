// SPDX-License-Identifier: Apache-2.0
#include "../../bench/rounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numeric>
#include <vector>

#include "phalanx/core/random.h"

namespace phalanx::bench {
namespace {

std::vector<double> count(int from, int to) {
  std::vector<double> values(static_cast<std::size_t>(to - from + 1));
  std::iota(values.begin(), values.end(), from);
  return values;
}

Rounds drawn(std::uint64_t seed, int rounds, double scale) {
  Random random(seed);
  Rounds all(static_cast<std::size_t>(rounds));
  for (auto& round : all) {
    for (int i = 0; i < 5000; ++i) round.push_back(scale * std::exp(random.normal()));
  }
  return all;
}

TEST(Rounds, APercentileIsTheNearestRankOfAllValuesTogether) {
  const Rounds rounds = {count(501, 1000), {}, count(1, 500)};
  EXPECT_EQ(percentile(rounds, 50.0), 500.0);
  EXPECT_EQ(percentile(rounds, 99.9), 999.0);
  EXPECT_EQ(percentile(rounds, 100.0), 1000.0);
  EXPECT_TRUE(std::isnan(percentile({{}, {}}, 50.0)));
}

TEST(Rounds, ARatioOfEqualRoundsHasNoSpread) {
  const Rounds quiet = {count(1, 1000), count(1, 1000)};
  Rounds loaded = quiet;
  for (auto& round : loaded)
    for (double& value : round) value *= 1.5;
  const Ratio found = ratio(loaded, quiet, 99.9);
  EXPECT_DOUBLE_EQ(found.value, 1.5);
  EXPECT_DOUBLE_EQ(found.low, 1.5);
  EXPECT_DOUBLE_EQ(found.high, 1.5);
}

// Each interval is meant to hold the truth 95 times of 100; twelve rounds are few, so that it does a little
// less often.
TEST(Rounds, TheIntervalHoldsTheTrueRatioNearlyAlwaysAndAnotherOneSeldom) {
  int held = 0;
  int other = 0;
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const Ratio found = ratio(drawn(1000 + seed, 12, 1.2), drawn(2000 + seed, 12, 1.0), 99.0);
    if (found.low <= 1.2 && 1.2 <= found.high) ++held;
    if (found.low <= 1.0 && 1.0 <= found.high) ++other;
  }
  std::printf("seeds 1000.. and 2000..: %d of %d held 1.2, %d held 1.0\n", held, kTrials, other);
  EXPECT_GE(held, 16);
  EXPECT_LE(other, 2);
}

}  // namespace
}  // namespace phalanx::bench
