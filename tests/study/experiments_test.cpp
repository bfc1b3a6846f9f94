// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/experiments.h"

#include <gmock/gmock.h>

#include "study/experiments/timing.h"

namespace phalanx {
namespace {

constexpr std::array<std::size_t, 3> kJointNumbers = {4, 6, 7};  // index MCP flexion, PIP, DIP

class S1Fig8 : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { situations_ = new std::vector<Fig8Situation>(run_s1_fig8()); }
  static void TearDownTestSuite() { delete situations_; }
  static std::vector<Fig8Situation>* situations_;
};
std::vector<Fig8Situation>* S1Fig8::situations_ = nullptr;

TEST_F(S1Fig8, HasSevenSituations) {
  std::string letters;
  for (const Fig8Situation& s : *situations_) letters += s.letter;
  EXPECT_EQ(letters, "abcdefg");
}

TEST_F(S1Fig8, TouchesWithTheSegmentsThatThePaperNamesAndNoOther) {
  for (const Fig8Situation& s : *situations_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const SegmentSnapshot& segment = s.held.segment[3 + k];
      EXPECT_EQ(segment.contact, s.touching[k]) << s.letter << ", segment " << k;
      EXPECT_EQ(segment.force > 0.1, s.touching[k]) << s.letter << ", segment " << k;
    }
    for (std::size_t other = 0; other < kSegments; ++other) {
      if (other < 3 || other > 5) {
        EXPECT_FALSE(s.held.segment[other].contact) << s.letter << ", segment " << other;
      }
    }
  }
}

TEST_F(S1Fig8, LoadsTheJointsThatThePaperNamesAndNoOther) {
  // (a) none, (b) MCP, (c) MCP and PIP, (d) all, (e) and (f), distal alone: all, (g) middle alone: MCP and
  // PIP.
  const std::array<std::array<bool, 3>, 7> loaded = {{{false, false, false},
                                                      {true, false, false},
                                                      {true, true, false},
                                                      {true, true, true},
                                                      {true, true, true},
                                                      {true, true, true},
                                                      {true, true, false}}};
  for (std::size_t i = 0; i < situations_->size(); ++i) {
    const Fig8Situation& s = (*situations_)[i];
    for (std::size_t j = 0; j < 3; ++j) {
      const double torque = s.held.torque[kJointNumbers[j]];
      EXPECT_EQ(carries_torque(s, static_cast<int>(j)), loaded[i][j]) << s.letter;
      if (loaded[i][j]) {
        EXPECT_LT(torque, -1e-3) << s.letter << ", joint " << j;
      } else {
        EXPECT_NEAR(torque, 0.0, 1e-12) << s.letter << ", joint " << j;
      }
    }
  }
}

// Smoothing has settled and no limit acted: each force is k d.                      S1 eq. (1)
TEST_F(S1Fig8, HoldsStillAtHookesForce) {
  for (const Fig8Situation& s : *situations_) {
    EXPECT_EQ(s.limited, Status::kOk) << s.letter;
    for (const SegmentSnapshot& segment : s.held.segment)
      EXPECT_NEAR(segment.force, 500.0 * segment.depth, 1e-9) << s.letter;
  }
}

TEST_F(S1Fig8, ReportsEverySituation) {
  const std::string text = fig8_text(*situations_);
  for (const Fig8Situation& s : *situations_) EXPECT_THAT(text, ::testing::HasSubstr(s.title));
  EXPECT_THAT(text, ::testing::HasSubstr("not printed"));
  const std::string csv = fig8_csv(*situations_);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 8);
}

int rounds_down_to_tens(int request, const SceneDescription&) { return request / 10 * 10; }

TEST(BestRequest, FindsTheNearestThatAMakerCanMake) {
  EXPECT_EQ(rounds_down_to_tens(best_request(118, rounds_down_to_tens, {}), {}), 120);
  EXPECT_EQ(rounds_down_to_tens(best_request(112, rounds_down_to_tens, {}), {}), 110);
}

TEST(Timing, HasThePapersTriangleCountsToWithinOnePercent) {
  const TimingResult s1 = run_s1_timing();
  EXPECT_NEAR(s1.hand_triangles + s1.object_triangles, 1489, 15);
  const TimingResult s2 = run_s2_timing();
  EXPECT_NEAR(s2.hand_triangles, 2248, 23);
  EXPECT_NEAR(s2.object_triangles, 992, 10);
  for (const TimingResult* result : {&s1, &s2}) {
    ASSERT_EQ(result->runs.size(), 2U);
    EXPECT_TRUE(result->runs[0].smoothing);
    EXPECT_FALSE(result->runs[1].smoothing);
    EXPECT_GT(result->runs[0].step_us.max, 0.0);
  }
  EXPECT_THAT(timing_text(s1), ::testing::HasSubstr("4.2 ms on average"));
  EXPECT_THAT(timing_text(s2), ::testing::HasSubstr("not printed"));
}

}  // namespace
}  // namespace phalanx
