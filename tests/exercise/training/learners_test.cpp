// SPDX-License-Identifier: Apache-2.0
// Simulated patients train for ten sessions. Their seeds are not those with which next_difficulty() was tuned
// (1000 to 1999).
#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include "exercise/training/simulated_learner.h"

namespace phalanx {
namespace {

constexpr int kTrials = 30;

std::string text_of_count(const LearnerCount& count) {
  return fmt::format(
      "{} patients: {} dropped out, {} in range, {} missed by their true success, {} by the observed one; "
      "not reported: {} of the missed, {} of the observed misses, {} more than 3 points beyond; in range and "
      "reported: {}",
      count.patients, count.dropped_out, count.in_range, count.missed, count.observed_missed, count.silent,
      count.silent_observed, count.silent_far, count.alarms);
}

void expect_reports(const LearnerCount& count) {
  SCOPED_TRACE(text_of_count(count));
  EXPECT_EQ(count.silent_observed, 0) << "a miss that was observed and not reported";
  EXPECT_LE(count.silent_far, count.patients / 50);
  EXPECT_LE(count.silent, count.patients * 5 / 100) << "close to the end, chance hides a few";
  EXPECT_LE(count.alarms, count.in_range * 35 / 100);
  EXPECT_GT(count.in_range, count.patients / 2);
  EXPECT_GT(count.dropped_out, 0);
}

TEST(Learners, ComeIntoRangeOrAreReported) { expect_reports(count_learners(31'000, 100, kTrials, {})); }

TEST(ManyLearners, ComeIntoRangeOrAreReported) {
  const LearnerCount count = count_learners(52'000, 1000, kTrials, {});
  fmt::print("{}\n", text_of_count(count));
  expect_reports(count);
}

}  // namespace
}  // namespace phalanx
