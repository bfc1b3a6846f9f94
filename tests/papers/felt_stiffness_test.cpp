// SPDX-License-Identifier: Apache-2.0
#include "papers/felt_stiffness.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "phalanx/study/laboratory/study_file.h"

namespace phalanx {
namespace {

Approach approach_with(Stabiliser method, double speed) {
  Approach approach;
  approach.law.stiffness = kFeltWall;
  approach.stabiliser.method = method;
  approach.speed = speed;
  return approach;
}

// The held force is that of a depth which is half a period old in the mean: k (1 - v T / (2 d)).
TEST(FeltStiffness, WithoutAStabiliserOnlyTheHoldIsMissing) {
  EXPECT_NEAR(felt_stiffness(approach_with(Stabiliser::kNone, 0.01)), 1580.0, 1.0);
  EXPECT_NEAR(felt_stiffness(approach_with(Stabiliser::kNone, 0.1)), 1400.0, 1.0);
  Approach quick = approach_with(Stabiliser::kNone, 0.1);
  quick.period = 0.001;
  EXPECT_NEAR(felt_stiffness(quick), 1560.0, 1.0);
}

// 2 mm at 50 mm/s are 40 ms and 8 steps of 0.1 N: 0.8 N over 2 mm. At 10 mm/s the law rises by 16 N/s, less
// than the bound of 20 N/s.
TEST(FeltStiffness, ABoundOfTheRiseIsFeltOnceTheLawRisesFaster) {
  for (const Stabiliser method : {Stabiliser::kSmoothing, Stabiliser::kRiseOnly}) {
    EXPECT_NEAR(felt_stiffness(approach_with(method, 0.05)), 393.75, 0.1);
    EXPECT_NEAR(felt_stiffness(approach_with(method, 0.1)), 196.875, 0.1);
    EXPECT_NEAR(felt_stiffness(approach_with(method, 0.01)), 1580.0, 1.0);
  }
}

// b v is 4 N s/m x 0.1 m/s = 0.4 N once the low-pass has settled: 200 N/m over 2 mm, less what it still
// lacks.
TEST(FeltStiffness, ADamperAddsItsForce) {
  const double without = felt_stiffness(approach_with(Stabiliser::kNone, 0.1));
  const double with = felt_stiffness(approach_with(Stabiliser::kKelvinVoigt, 0.1));
  EXPECT_GT(with, without + 0.8 * 200.0);
  EXPECT_LT(with, without + 200.0);
}

// The controller's hold of 1 ms is what is left: k (1 - v T / (2 d)) with its T.
TEST(FeltStiffness, ALocalWallIsFeltAtTheControllersRate) {
  EXPECT_NEAR(felt_stiffness(approach_with(Stabiliser::kLocalWall, 0.1)), 1560.0, 1.0);
  Approach slow = approach_with(Stabiliser::kLocalWall, 0.1);
  slow.controller_period = 0.005;
  EXPECT_NEAR(felt_stiffness(slow), 1400.0, 1.0);
}

// 0.5 m/s and 2 mm are 4 ms, so that for a fifth of the phases no step comes in time: 0.8 k times the mean of
// what the others see, k v (4 ms - first), over 2 mm.
TEST(FeltStiffness, AFingerThatIsDeepBeforeTheFirstStepFeelsNothing) {
  const double expected = 0.8 * kFeltWall * 0.5 * 0.002 / kFeltDepth;
  EXPECT_NEAR(felt_stiffness(approach_with(Stabiliser::kNone, 0.5)), expected, 1.0);
  EXPECT_NEAR(felt_stiffness(approach_with(Stabiliser::kNone, 5.0), 1), 0.0, 0.0);
  EXPECT_NEAR(felt_stiffness(approach_with(Stabiliser::kLocalWall, 5.0), 1), 0.0, 0.0);
}

TEST(FeltStiffness, HasTheRowsOfTheStudyOfStabilisers) {
  const Study study = load_study(std::string(PHALANX_SOURCE_DIR) + "/studies/stabilisers.toml");
  ASSERT_EQ(felt_variants().size(), study.variants.size());
  for (std::size_t i = 0; i < study.variants.size(); ++i) {
    EXPECT_EQ(felt_variants()[i].first, study.variants[i].name);
    for (const auto& [key, value] : felt_variants()[i].second)
      EXPECT_THAT(study.variants[i].set, ::testing::Contains(::testing::Pair(key, value)));
  }
}

TEST(FeltStiffness, TheReportHasEveryRowAndSpeed) {
  const std::vector<FeltRow> rows = run_felt_stiffness();
  ASSERT_EQ(rows.size(), felt_variants().size());
  EXPECT_EQ(rows[0].name, "none");
  EXPECT_NEAR(rows[0].stiffness.at(3), 1400.0, 1.0);
  EXPECT_NEAR(rows[2].stiffness.at(2), 198.4375, 0.1) << "0.05 N a step at 50 mm/s, as above";
  EXPECT_NEAR(rows[15].stiffness.at(3), 1560.0, 1.0) << "host at 1 kHz";
  const ExperimentReport report = felt_stiffness_report(rows);
  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json.at("rows").size(), rows.size());
  EXPECT_EQ(json.at("speeds_mm_per_s"), (nlohmann::json{10.0, 20.0, 50.0, 100.0, 200.0}));
  EXPECT_NEAR(json.at("rows").at(0).at("felt_n_per_mm").at(3).get<double>(), 1.4, 1e-3);
  EXPECT_THAT(report.csv, ::testing::StartsWith("stabiliser,felt_n_per_mm_at_10_mm_per_s,"));
  EXPECT_THAT(report.csv, ::testing::HasSubstr("\n\"rise only 0.1 N a step\",1.58,"));
  EXPECT_THAT(report.text, ::testing::HasSubstr("local wall at 1 kHz"));
  EXPECT_THAT(report.svg, ::testing::HasSubstr("<svg"));
}

}  // namespace
}  // namespace phalanx
