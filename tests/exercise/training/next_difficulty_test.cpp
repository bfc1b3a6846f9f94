// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "phalanx/exercise/training.h"

namespace phalanx {
namespace {

TEST(NextDifficulty, WithoutASessionIsTheStart) {
  EXPECT_DOUBLE_EQ(next_difficulty({}, {.start = 0.35}), 0.35);
  const std::vector<TrainingSession> empty = {{.difficulty = 0.5, .successes = 0, .counted = 0}};
  EXPECT_DOUBLE_EQ(next_difficulty(empty, {.start = 0.35}), 0.35) << "a session without a trial says nothing";
}

TEST(NextDifficulty, RisesAfterSuccessAndFallsAfterFailure) {
  const Difficulty difficulty = {.start = 0.4};
  double last = -1.0;
  for (const int successes : {0, 6, 12, 18, 24, 30}) {
    const std::vector<TrainingSession> history = {{.difficulty = 0.4, .successes = successes, .counted = 30}};
    const double next = next_difficulty(history, difficulty);
    EXPECT_GE(next, last) << successes;
    last = next;
    if (successes <= 12) {
      EXPECT_LT(next, 0.4);
    }
    if (successes >= 24) {
      EXPECT_GT(next, 0.4);
    }
  }
}

TEST(NextDifficulty, FindsTheDifficultyOfASteadyPerson) {
  // Success is 0.7 where the logistic function with ability 0.6 and width 0.1 is: at 0.6 - 0.1 ln(0.7 /
  // 0.3) = 0.515.
  const Difficulty difficulty = {.start = 0.3};
  std::vector<TrainingSession> history;
  for (int i = 0; i < 10; ++i) {
    const double next = next_difficulty(history, difficulty);
    const double share = 1.0 / (1.0 + std::exp(-(0.6 - next) / 0.1));
    history.push_back(
        {.difficulty = next, .successes = static_cast<int>(std::lround(30 * share)), .counted = 30});
  }
  EXPECT_NEAR(next_difficulty(history, difficulty), 0.515, 0.03);
}

TEST(NextDifficulty, ThePartsOfASessionMoveTheAbilityOnOnce) {
  // One trial each: without a drift between the parts, their order does not matter.
  const TrainingSession failure = {.difficulty = 0.3, .successes = 0, .counted = 1};
  const TrainingSession success = {.difficulty = 0.6, .successes = 1, .counted = 1};
  const auto continued = [](TrainingSession part) {
    part.continues = true;
    return part;
  };
  const auto next = [](const std::vector<TrainingSession>& history) { return next_difficulty(history, {}); };
  const double together = next({failure, continued(success)});
  EXPECT_NEAR(together, next({success, continued(failure)}), 1e-5);
  EXPECT_GT(std::abs(next({failure, success}) - next({success, failure})), 1e-4) << "two sessions";
  TrainingSession empty = failure;
  empty.counted = 0;
  EXPECT_DOUBLE_EQ(next({failure, continued(success), empty}), together) << "it says nothing";
  EXPECT_DOUBLE_EQ(next({continued(failure)}), next({failure})) << "there is none before it";
}

TEST(NextDifficulty, StaysWithinItsScaleAndIgnoresSessionsThatCannotBe) {
  std::vector<TrainingSession> never(12, {.difficulty = 0.0, .successes = 0, .counted = 30});
  EXPECT_DOUBLE_EQ(next_difficulty(never, {}), 0.0);
  std::vector<TrainingSession> always(12, {.difficulty = 1.0, .successes = 30, .counted = 30});
  EXPECT_DOUBLE_EQ(next_difficulty(always, {}), 1.0);
  const std::vector<TrainingSession> odd = {
      {.difficulty = std::numeric_limits<double>::quiet_NaN(), .successes = 3, .counted = 4},
      {.difficulty = 0.5, .successes = 9, .counted = 4},
      {.difficulty = 7.0, .successes = 1, .counted = 4}};
  EXPECT_DOUBLE_EQ(next_difficulty(odd, {.start = 0.2}), 0.2);
}

}  // namespace
}  // namespace phalanx
