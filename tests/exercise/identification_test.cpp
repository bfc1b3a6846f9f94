// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/identification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/exercise/score.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

/// Sums P(X = k) from the ways' recursion, independent of the product's logarithms.
double binomial_sum(int from, int to, int trials, double p) {
  double sum = 0.0;
  for (int k = from; k <= to; ++k) {
    double term = 1.0;
    for (int i = 0; i < k; ++i) term *= static_cast<double>(trials - i) / (k - i) * p;
    for (int i = k; i < trials; ++i) term *= 1.0 - p;
    sum += term;
  }
  return sum;
}

TEST(ExactProportion, HasTheEndsThatTheBinomialDistributionDemands) {
  for (const int trials : {1, 7, 24, 40}) {
    for (int successes = 0; successes <= trials; ++successes) {
      SCOPED_TRACE(trials);
      SCOPED_TRACE(successes);
      const Proportion p = exact_proportion(successes, trials);
      EXPECT_DOUBLE_EQ(p.value, static_cast<double>(successes) / trials);
      if (successes > 0) {
        EXPECT_NEAR(binomial_sum(successes, trials, trials, p.low), 0.025, 1e-9);
      }
      if (successes < trials) {
        EXPECT_NEAR(binomial_sum(0, successes, trials, p.high), 0.025, 1e-9);
      }
    }
  }
}

TEST(ExactProportion, HasTheKnownEndsWithoutAndWithOnlySuccesses) {
  EXPECT_DOUBLE_EQ(exact_proportion(0, 10).low, 0.0);
  EXPECT_NEAR(exact_proportion(0, 10).high, 1.0 - std::pow(0.025, 0.1), 1e-12);  // 0.3085
  EXPECT_NEAR(exact_proportion(10, 10).low, std::pow(0.025, 0.1), 1e-12);        // 0.6915
  EXPECT_DOUBLE_EQ(exact_proportion(10, 10).high, 1.0);
}

TEST(ExactProportion, RefusesWhatIsNoProportion) {
  EXPECT_THROW((void)exact_proportion(0, 0), std::invalid_argument);
  EXPECT_THROW((void)exact_proportion(-1, 4), std::invalid_argument);
  EXPECT_THROW((void)exact_proportion(5, 4), std::invalid_argument);
  EXPECT_THROW((void)exact_proportion(2, 4, 1.0), std::invalid_argument);
}

TEST(TransmittedBits, EqualsTheWorkedExamples) {
  EXPECT_NEAR(transmitted_bits({5, 0, 0, 5}, 2), 1.0, 1e-12);
  EXPECT_NEAR(transmitted_bits({5, 5, 5, 5}, 2), 0.0, 1e-12);
  EXPECT_NEAR(transmitted_bits({3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3}, 4), 2.0, 1e-12);
  // 8 of 10 right: 1 - H(0.2) = 1 + 0.2 log2 0.2 + 0.8 log2 0.8 = 0.278072
  EXPECT_NEAR(transmitted_bits({8, 2, 2, 8}, 2), 0.278072, 1e-6);
  // (2 - 1) (2 - 1) / (2 * 20 * ln 2) = 0.036067
  EXPECT_NEAR(transmitted_bits_bias({8, 2, 2, 8}, 2), 0.036067, 1e-6);
  EXPECT_EQ(transmitted_bits_bias({8, 0, 2, 0}, 2), 0.0) << "one answer alone transmits nothing";
  EXPECT_EQ(transmitted_bits({0, 0, 0, 0}, 2), 0.0);
  EXPECT_THROW((void)transmitted_bits({1, 2, 3}, 2), std::invalid_argument);
  EXPECT_THROW((void)transmitted_bits({1, -2, 3, 0}, 2), std::invalid_argument);
}

TEST(TransmittedBits, TheCorrectionRemovesMostOfTheBiasOfGuesses) {
  // 4 objects, 6 times each, guessed: the plain number averages near (4 - 1)^2 / (2 * 24 * ln 2) = 0.27
  // bit, not 0.
  Random random(31);
  double plain = 0.0;
  double corrected = 0.0;
  const int runs = 2000;
  for (int run = 0; run < runs; ++run) {
    std::vector<int> confusion(16);
    for (std::size_t i = 0; i < 24; ++i) {
      ++confusion[i / 6 * 4 + static_cast<std::size_t>(4.0 * random.uniform())];
    }
    plain += transmitted_bits(confusion, 4) / runs;
    corrected += (transmitted_bits(confusion, 4) - transmitted_bits_bias(confusion, 4)) / runs;
  }
  EXPECT_GT(plain, 0.25);
  EXPECT_LT(std::abs(corrected), plain / 3.0) << corrected;
}

TEST(Identification, PresentsEachObjectEquallyOften) {
  for (std::uint64_t seed = 40; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Identification run(5, 4, seed);
    std::map<int, int> presented;
    while (const auto object = run.object()) {
      ++presented[*object];
      run.answer(*object);
    }
    ASSERT_EQ(presented.size(), 5U);
    for (const auto& [object, count] : presented) EXPECT_EQ(count, 4) << object;
    const IdentificationResult result = run.result();
    EXPECT_EQ(result.invalid, "");
    EXPECT_DOUBLE_EQ(result.right.value, 1.0);
    EXPECT_NEAR(result.plain_bits, std::log2(5.0), 1e-12);
    EXPECT_NEAR(result.most_bits, std::log2(5.0), 1e-12);
    EXPECT_DOUBLE_EQ(result.chance, 0.2);
  }
}

TEST(Identification, CountsAnswersInTheConfusionMatrix) {
  Identification run(2, 10, 51);
  int zero_as_one = 2;
  int one_as_zero = 2;
  while (const auto object = run.object()) {
    int& errors = *object == 0 ? zero_as_one : one_as_zero;
    run.answer(errors > 0 ? 1 - *object : *object);
    if (errors > 0) --errors;
  }
  const IdentificationResult result = run.result();
  EXPECT_EQ(result.confusion, (std::vector<int>{8, 2, 2, 8}));
  EXPECT_DOUBLE_EQ(result.right.value, 0.8);
  EXPECT_NEAR(result.bits, 0.278072 - 0.036067, 1e-5);
  EXPECT_NEAR(result.plain_bits, 0.278072, 1e-6);
  const std::vector<Score> scores = identification_scores(result);
  ASSERT_EQ(scores.size(), 5U);
  EXPECT_DOUBLE_EQ(scores[0].value, 80.0);
  EXPECT_NEAR(scores[1].value, 56.34, 0.01);  // Clopper & Pearson's interval of 16 in 20
  EXPECT_NEAR(scores[2].value, 94.27, 0.01);
}

TEST(Identification, ADiscardedObjectComesAgainButNotForEver) {
  Identification run(3, 2, 52);
  int presented = 0;
  while (run.object()) {
    ++presented;
    ASSERT_LE(presented, 12);
    run.discard();
  }
  EXPECT_EQ(presented, 12) << "each object once more for each of its two rounds";
  EXPECT_THAT(run.result().invalid, HasSubstr("too few trials: 0 of 6"));
  for (const Score& score : identification_scores(run.result())) EXPECT_FALSE(score.valid());
  run.discard();
  EXPECT_THROW(run.answer(0), std::logic_error);
}

TEST(Identification, ADiscardKeepsTheBalance) {
  Identification run(3, 3, 53);
  int presented = 0;
  while (const auto object = run.object()) {
    if (presented++ < 2) {
      run.discard();
    } else {
      run.answer(*object);
    }
  }
  const IdentificationResult result = run.result();
  EXPECT_EQ(result.trials, 9);
  EXPECT_EQ(result.discarded, 2);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(result.confusion[4 * i], 3);
}

TEST(Identification, RefusesWrongArgumentsAndAnswers) {
  EXPECT_THROW(Identification(1, 4, 0), std::invalid_argument);
  EXPECT_THROW(Identification(13, 4, 0), std::invalid_argument);
  EXPECT_THROW(Identification(4, 0, 0), std::invalid_argument);
  Identification run(4, 2, 54);
  EXPECT_THROW(run.answer(4), std::invalid_argument);
  EXPECT_THROW(run.answer(-1), std::invalid_argument);
  EXPECT_THAT(run.result().invalid, HasSubstr("not finished: 0 of 8"));
}

}  // namespace
}  // namespace phalanx
