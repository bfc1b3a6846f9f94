// SPDX-License-Identifier: Apache-2.0
#include "phalanx/papers/experiments.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "papers/s1_fig8.h"
#include "papers/timing.h"

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

/// Made up: the numbers of joints 4, 6 and 7 and of segments 3, 4 and 5 all differ, as do what S1 says of the
/// contacts and what there is.
Fig8Situation made_up_situation() {
  Fig8Situation s;
  s.letter = 'c';
  s.title = "made up";
  s.touching = {true, true, false};
  s.ball_diameter = 0.05;
  s.ball_centre = Vec3(0.5, 0.25, -0.125);
  for (std::size_t j = 0; j < 3; ++j) {
    const double quarters = 0.25 * static_cast<double>(j + 1);
    s.held.hcp_angle[kJointNumbers[j]] = 1.0 + quarters;
    s.held.gdp_angle[kJointNumbers[j]] = 2.0 + quarters;
    s.held.torque[kJointNumbers[j]] = -3.0 - quarters;
  }
  s.held.segment[3].contact = s.held.segment[5].contact = true;
  s.held.segment[3].depth = 0.001;
  s.held.segment[3].force = 0.5;
  s.held.segment[5].depth = 0.002;
  s.held.segment[5].force = 1.5;
  return s;
}

TEST(Fig8Csv, NamesEveryNumber) {
  EXPECT_EQ(fig8_csv({made_up_situation()}),
            "situation,mcp_hcp_rad,mcp_gdp_rad,mcp_torque_nm,pip_hcp_rad,pip_gdp_rad,pip_torque_nm,"
            "dip_hcp_rad,dip_gdp_rad,dip_torque_nm,proximal_contact,proximal_depth_m,proximal_force_n,"
            "middle_contact,middle_depth_m,middle_force_n,distal_contact,distal_depth_m,distal_force_n\n"
            "c,1.25,2.25,-3.25,1.5,2.5,-3.5,1.75,2.75,-3.75,1,0.001,0.5,0,0,0,1,0.002,1.5\n");
}

TEST(Fig8Json, NamesEveryNumber) {
  auto json = nlohmann::json::parse(fig8_json({made_up_situation()}));
  EXPECT_TRUE(json.contains("made"));
  json.erase("made");
  const auto expected = nlohmann::json::parse(R"json({
    "experiment": "s1-fig8", "paper": "S1 fig. 8", "paper_values": "not printed",
    "situations": [{
      "situation": "c", "title": "made up",
      "ball": {"diameter_m": 0.05, "centre_m": [0.5, 0.25, -0.125]},
      "joints": {
        "MCP flexion": {"hcp_rad": 1.25, "gdp_rad": 2.25, "torque_nm": -3.25, "carries_torque_in_s1": true},
        "PIP": {"hcp_rad": 1.5, "gdp_rad": 2.5, "torque_nm": -3.5, "carries_torque_in_s1": true},
        "DIP": {"hcp_rad": 1.75, "gdp_rad": 2.75, "torque_nm": -3.75, "carries_torque_in_s1": false}},
      "segments": {
        "proximal": {"contact": true, "in_contact_in_s1": true, "depth_m": 0.001, "force_n": 0.5},
        "middle": {"contact": false, "in_contact_in_s1": true, "depth_m": 0.0, "force_n": 0.0},
        "distal": {"contact": true, "in_contact_in_s1": false, "depth_m": 0.002, "force_n": 1.5}}}]})json");
  EXPECT_EQ(json, expected);
}

TEST(Experiments, BeginWithTheSevenSituationsThatAllAgree) {
  const Experiment& first = experiments().front();
  EXPECT_EQ(first.name, "s1-fig8");
  const ExperimentReport report = first.run();
  ASSERT_EQ(report.rows.size(), 1U);
  EXPECT_EQ(report.rows[0].ours, "7 of 7");
  EXPECT_EQ(report.rows[0].difference, "agrees");
  EXPECT_EQ(std::count(report.csv.begin(), report.csv.end(), '\n'), 8);
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
