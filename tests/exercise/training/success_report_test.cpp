// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <vector>

#include "phalanx/exercise/training.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

/// Ten sessions, the last three with these successes of 30 trials each.
std::vector<TrainingSession> sessions_with(int a, int b, int c) {
  std::vector<TrainingSession> history(7, {.difficulty = 0.5, .successes = 0, .counted = 30});
  for (const int successes : {a, b, c})
    history.push_back({.difficulty = 0.5, .successes = successes, .counted = 30});
  return history;
}

TEST(SuccessReport, JudgesTheLastThreeOfTenSessions) {
  const SuccessReport report = success_report(sessions_with(21, 22, 20), 0.7);
  EXPECT_EQ(report.verdict, SuccessVerdict::kInRange);
  EXPECT_FALSE(report.reported());
  EXPECT_EQ(report.successes, 63);
  EXPECT_EQ(report.counted, 90);
  // Clopper and Pearson for 63 of 90: 0.5943 to 0.7921.
  EXPECT_NEAR(report.low, 0.5943, 1e-3);
  EXPECT_NEAR(report.high, 0.7921, 1e-3);
  EXPECT_THAT(report.text,
              HasSubstr("in range: success in 63 of 90 trials (70 %, 95 % interval 59 to 79 %)"));
}

TEST(SuccessReport, ReportsAMissInWords) {
  const SuccessReport far = success_report(sessions_with(10, 12, 11), 0.7);
  EXPECT_EQ(far.verdict, SuccessVerdict::kOutOfRange);
  EXPECT_THAT(far.text, HasSubstr("out of range after 10 sessions: success in 33 of 90 trials (37 %"));
  EXPECT_THAT(far.text, HasSubstr("below 60 to 80 %; chance does not explain it"));
  const SuccessReport near = success_report(sessions_with(25, 25, 23), 0.7);
  EXPECT_EQ(near.verdict, SuccessVerdict::kOutOfRange);
  EXPECT_THAT(near.text, HasSubstr("above 60 to 80 %; it may be chance"));
}

TEST(SuccessReport, ReportsAShareThatIsTooNearTheEnd) {
  const SuccessReport report = success_report(sessions_with(24, 23, 24), 0.7);
  EXPECT_EQ(report.verdict, SuccessVerdict::kNotShown);
  EXPECT_TRUE(report.reported());
  EXPECT_THAT(report.text, HasSubstr("not shown after 10 sessions"));
}

TEST(SuccessReport, EveryShareBeyondTheMarginIsReportedForEveryNumberOfTrials) {
  for (int counted = 1; counted <= 40; ++counted)
    for (int successes = 0; successes <= counted; ++successes) {
      std::vector<TrainingSession> history(10,
                                           {.difficulty = 0.5, .successes = successes, .counted = counted});
      const double share = static_cast<double>(successes) / counted;
      const SuccessReport report = success_report(history, 0.7);
      if (share < 0.6 - 1e-9 || share > 0.8 + 1e-9) {
        EXPECT_EQ(report.verdict, SuccessVerdict::kOutOfRange) << successes << " of " << counted;
      } else {
        EXPECT_NE(report.verdict, SuccessVerdict::kOutOfRange) << successes << " of " << counted;
      }
    }
}

TEST(SuccessReport, ReportsDropoutsAndEmptySessions) {
  const SuccessReport none = success_report({}, 0.7);
  EXPECT_TRUE(none.reported());
  EXPECT_EQ(none.text, "not judged: 0 of 10 sessions were done");
  std::vector<TrainingSession> history = sessions_with(21, 21, 21);
  history.pop_back();
  EXPECT_EQ(success_report(history, 0.7).text, "not judged: 9 of 10 sessions were done");
  history.push_back({.difficulty = 0.5, .successes = 0, .counted = 0});
  EXPECT_EQ(success_report(history, 0.7).verdict, SuccessVerdict::kTooFewSessions);
  EXPECT_THAT(success_report(history, 0.7).text, HasSubstr("no valid trial"));
}

TEST(SuccessReport, FollowsAPrescribedTarget) {
  EXPECT_EQ(success_report(sessions_with(15, 15, 15), 0.5).verdict, SuccessVerdict::kInRange);
  EXPECT_EQ(success_report(sessions_with(15, 15, 15), 0.7).verdict, SuccessVerdict::kOutOfRange);
}

}  // namespace
}  // namespace phalanx
