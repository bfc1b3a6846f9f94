// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/limit_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace phalanx {
namespace {

/// Searches a grid whose verdicts are written down, and fails if one is asked for twice.
LimitSearch search(const std::vector<bool>& verdicts, int coarse = 4) {
  std::set<int> asked;
  return search_limit(
      static_cast<int>(verdicts.size()),
      [&](int index) {
        EXPECT_TRUE(asked.insert(index).second) << "asked twice for " << index;
        return verdicts.at(static_cast<std::size_t>(index));
      },
      coarse);
}

std::vector<bool> stable_up_to(int limit, int size) {
  std::vector<bool> verdicts(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) verdicts[static_cast<std::size_t>(i)] = i <= limit;
  return verdicts;
}

std::set<int> tried(const LimitSearch& search) {
  std::set<int> indices;
  for (const CheckedStiffness& checked : search.checked) indices.insert(checked.index);
  return indices;
}

TEST(LimitSearch, FindsEveryLimitOfEveryMonotoneGrid) {
  for (int size = 1; size <= 41; ++size) {
    for (int limit = -1; limit < size; ++limit) {
      const LimitSearch found = search(stable_up_to(limit, size));
      EXPECT_EQ(found.limit, limit) << "of " << size;
      EXPECT_EQ(found.at_least, limit == size - 1) << "of " << size;
      EXPECT_FALSE(found.non_monotone) << "of " << size;
      EXPECT_LE(static_cast<int>(found.checked.size()), most_checked_if_monotone(size));
    }
  }
}

// 40 points: 10 coarse and the last, 2 of the bisection inside 16..20, and the rest of two further on each
// side of 17|18.
TEST(LimitSearch, TriesTheWholeGridCoarselyAndTwoFurtherPointsOnEachSide) {
  EXPECT_EQ(tried(search(stable_up_to(17, 40))),
            (std::set<int>{0, 4, 8, 12, 15, 16, 17, 18, 19, 20, 24, 28, 32, 36, 39}));
}

TEST(LimitSearch, SaysThatNoneIsStable) {
  const LimitSearch found = search(stable_up_to(-1, 10));
  EXPECT_EQ(found.limit, -1);
  EXPECT_FALSE(found.at_least);
  EXPECT_EQ(tried(found), (std::set<int>{0, 1, 2, 4, 8, 9}));
}

TEST(LimitSearch, SaysThatTheLimitIsAtLeastTheGridsLast) {
  const LimitSearch found = search(stable_up_to(9, 10));
  EXPECT_EQ(found.limit, 9);
  EXPECT_TRUE(found.at_least);
  EXPECT_EQ(tried(found), (std::set<int>{0, 4, 7, 8, 9}));
}

TEST(LimitSearch, GoesBelowAnInstabilityThatTheFurtherChecksFind) {
  auto verdicts = stable_up_to(17, 40);
  verdicts[15] = false;  // two below the boundary that the bisection finds
  const LimitSearch found = search(verdicts);
  EXPECT_EQ(found.limit, 14);
  EXPECT_TRUE(found.non_monotone);
  EXPECT_TRUE(tried(found).contains(12) && tried(found).contains(13) && tried(found).contains(14));
}

TEST(LimitSearch, ReportsAStableIslandAboveTheLimit) {
  auto verdicts = stable_up_to(17, 40);
  verdicts[28] = true;
  const LimitSearch found = search(verdicts);
  EXPECT_EQ(found.limit, 17);
  EXPECT_TRUE(found.non_monotone);
}

TEST(LimitSearch, StopsBelowTheFirstCoarseInstability) {
  auto verdicts = stable_up_to(30, 40);
  verdicts[8] = false;
  const LimitSearch found = search(verdicts);
  EXPECT_EQ(found.limit, 7);
  EXPECT_TRUE(found.non_monotone);
}

// What the header guarantees, on 20,000 seeded grids that are stable at random.
TEST(LimitSearch, KeepsItsGuaranteesWhateverTheVerdicts) {
  constexpr unsigned kSeed = 20260501;
  std::mt19937 random(kSeed);
  for (int trial = 0; trial < 20'000; ++trial) {
    const int size = 1 + static_cast<int>(random() % 40);
    const int coarse = 1 + static_cast<int>(random() % 6);
    const auto likely = 1 + random() % 20;  // from every second unstable to nearly none
    std::vector<bool> verdicts(static_cast<std::size_t>(size));
    for (int i = 0; i < size; ++i) verdicts[static_cast<std::size_t>(i)] = random() % (likely + 1) != 0;
    const LimitSearch found = search(verdicts, coarse);
    const std::set<int> indices = tried(found);
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed << ", trial " << trial);
    ASSERT_GE(found.limit, -1);
    ASSERT_EQ(found.at_least, found.limit == size - 1);
    for (const CheckedStiffness& checked : found.checked) {
      ASSERT_EQ(checked.stable, verdicts[static_cast<std::size_t>(checked.index)]);
      ASSERT_TRUE(checked.stable || checked.index > found.limit);
      ASSERT_FALSE(checked.stable && checked.index == found.limit + 1);
    }
    for (int i = found.limit - 2; i <= found.limit + 3; ++i) {
      ASSERT_TRUE(i < 0 || i >= size || indices.contains(i)) << i;
    }
    for (int i = 0; i < size; i += coarse) ASSERT_TRUE(indices.contains(i)) << i;
    ASSERT_TRUE(indices.contains(size - 1));
  }
}

TEST(LimitSearch, RefusesAnEmptyGrid) {
  const auto always = [](int) { return true; };
  EXPECT_THROW(static_cast<void>(search_limit(0, always)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(search_limit(3, always, 0)), std::invalid_argument);
}

TEST(LimitSearch, LetsAnExceptionThrough) {
  const auto fails = [](int) -> bool { throw std::runtime_error("device on fire"); };
  EXPECT_THROW(static_cast<void>(search_limit(5, fails)), std::runtime_error);
}

// The estimate looks at both ends of a long grid only; it must be what the whole would give.
TEST(LimitSearch, EstimatesTheMostPointsOfALongGrid) {
  for (const int size : {1, 2, 40, 41, 42, 43, 100}) {
    int most = 0;
    for (int limit = -1; limit < size; ++limit)
      most = std::max(most, static_cast<int>(search(stable_up_to(limit, size)).checked.size()));
    EXPECT_EQ(most_checked_if_monotone(size), most) << size;
  }
}

/// The limit of each seed, and a point below it at which the seed is unstable; -1: none.
struct Seed {
  int limit = -1;
  int hole = -1;
};

struct Trace {
  TracedLimit found;
  std::set<std::pair<int, int>> asked;
};

/// Traces a limit, and fails if a pair is asked for twice.
Trace trace(int size, const std::vector<Seed>& seeds, int coarse = 4) {
  Trace trace;
  trace.found = trace_limit(
      size, static_cast<int>(seeds.size()),
      [&](int index, int number) {
        EXPECT_TRUE(trace.asked.emplace(index, number).second) << index << ", seed " << number;
        const Seed& seed = seeds.at(static_cast<std::size_t>(number));
        return index <= seed.limit && index != seed.hole;
      },
      coarse);
  return trace;
}

TEST(TracedLimit, IsTheLeastOfTheSeedsLimits) {
  std::mt19937 random(7);
  constexpr int kCases = 2000;
  for (int n = 0; n < kCases; ++n) {
    SCOPED_TRACE(::testing::Message() << "case " << n);
    const int size = 1 + static_cast<int>(random() % 60);
    std::vector<Seed> seeds(1 + random() % 24);
    int least = size - 1;
    for (Seed& seed : seeds) {
      seed.limit = static_cast<int>(random() % static_cast<unsigned>(size + 4)) - 1;
      least = std::min(least, seed.limit);
    }
    const Trace found = trace(size, seeds);
    EXPECT_EQ(found.found.limit, least);
    EXPECT_EQ(found.found.at_least, least == size - 1);
    EXPECT_FALSE(found.found.non_monotone);
    EXPECT_LE(static_cast<int>(found.asked.size()),
              most_traced_if_monotone(size, static_cast<int>(seeds.size())));
    for (int seed = 0; least >= 0 && seed < static_cast<int>(seeds.size()); ++seed)
      EXPECT_TRUE(found.asked.contains({least, seed})) << "all seeds are tried at the limit";
  }
}

// 40 points and 20 seeds whose limits are 17 to 20. A scan runs all seeds at seven stable points: 140 trials.
TEST(TracedLimit, NeedsInTheMeanLessThanTwoTrialsASeed) {
  std::mt19937 random(11);
  constexpr std::size_t kCases = 200;
  std::size_t trials = 0;
  for (std::size_t n = 0; n < kCases; ++n) {
    std::vector<Seed> seeds(20);
    for (Seed& seed : seeds) seed.limit = 17 + static_cast<int>(random() % 4);
    trials += trace(40, seeds).asked.size();
  }
  EXPECT_LT(trials, kCases * 2 * 20);
}

TEST(TracedLimit, FindsAWideInstabilityBelowAndStatesThatItIsNotMonotone) {
  // Below the limit the third seed alone is tried at 8, where it is unstable.
  const Trace found = trace(40, {{.limit = 30}, {.limit = 31}, {.limit = 32, .hole = 8}});
  EXPECT_EQ(found.found.limit, 7);
  EXPECT_TRUE(found.found.non_monotone);
  EXPECT_FALSE(found.found.at_least);
}

TEST(TracedLimit, MovesBelowASeedThatIsUnstableAtTheLimitOfTheOthers) {
  // The first seed is stable at 20, where the search begins, and unstable at 12, the limit of the second one.
  const Trace found = trace(40, {{.limit = 25, .hole = 12}, {.limit = 12}});
  EXPECT_EQ(found.found.limit, 11);
  EXPECT_TRUE(found.found.non_monotone);
}

// Verdicts without any order, most of them stable at first.
TEST(TracedLimit, KeepsItsGuaranteesWithAnyVerdicts) {
  std::mt19937 random(23);
  for (int n = 0; n < 10'000; ++n) {
    SCOPED_TRACE(::testing::Message() << "case " << n);
    const int size = 1 + static_cast<int>(random() % 30);
    const int seeds = 1 + static_cast<int>(random() % 6);
    const int coarse = 1 + static_cast<int>(random() % 6);
    const unsigned unstable = 1 + static_cast<unsigned>(random() % 20);  // of 20
    std::map<std::pair<int, int>, bool> verdicts;                        // by seed, then point
    const TracedLimit found = trace_limit(
        size, seeds,
        [&](int index, int seed) {
          EXPECT_TRUE(index >= 0 && index < size && seed >= 0 && seed < seeds);
          const auto [it, is_new] = verdicts.emplace(std::pair(seed, index), random() % 20 >= unstable);
          EXPECT_TRUE(is_new) << "asked twice";
          return it->second;
        },
        coarse);
    ASSERT_TRUE(found.limit >= -1 && found.limit < size);
    EXPECT_EQ(found.at_least, found.limit == size - 1);
    bool unstable_above = found.at_least;
    bool non_monotone = false;
    for (const auto& [pair, stable] : verdicts) {
      const auto& [seed, index] = pair;
      unstable_above = unstable_above || (index == found.limit + 1 && !stable);
      for (const auto& [other, stable_there] : verdicts)
        non_monotone =
            non_monotone || (other.first == seed && other.second > index && !stable && stable_there);
    }
    EXPECT_TRUE(unstable_above);
    EXPECT_EQ(found.non_monotone, non_monotone);
    for (int seed = 0; found.limit >= 0 && seed < seeds; ++seed)
      EXPECT_TRUE(verdicts.at({seed, found.limit})) << "seed " << seed;
    for (int index = 0; index < found.limit; index += coarse)
      EXPECT_TRUE(verdicts.at({index / coarse % seeds, index})) << "point " << index;
  }
}

TEST(TracedLimit, RefusesAnEmptyGridNoSeedsAndNoStep) {
  const auto stable = [](int, int) { return true; };
  EXPECT_THROW(static_cast<void>(trace_limit(0, 1, stable)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(trace_limit(1, 0, stable)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(trace_limit(1, 1, stable, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
