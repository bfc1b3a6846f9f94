// SPDX-License-Identifier: Apache-2.0
// The one number that is fitted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "papers/s2_experiments.h"
#include "phalanx/scene/patient_file.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

// S2 prints 0.7 and 1.6 N/mm. In steps of 0.1 N/mm the rows deviate by 3 and -1: 10; 1 and 2: 5; -2 and -1:
// 5; -3 and 0: 9. Of the two with 5 the harder bump is taken.
TEST(S2FitReport, TakesTheLeastSquaredDeviationAndOfSeveralTheHardestBump) {
  const ExperimentReport report = s2_fit_report({{.bump = 0.5, .none = 1000.0, .smoothing = 1500.0},
                                                 {.bump = 1.0, .none = 800.0, .smoothing = 1800.0},
                                                 {.bump = 1.5, .none = 500.0, .smoothing = 1500.0},
                                                 {.bump = 2.0, .none = 400.0, .smoothing = 1600.0}});
  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json.at("fitted_bump_n"), 1.5);
  EXPECT_EQ(json.at("rows"), nlohmann::json::parse(R"([
    {"bump_n": 0.5, "none_n_per_mm": 1.0, "smoothing_n_per_mm": 1.5, "deviation": 10},
    {"bump_n": 1.0, "none_n_per_mm": 0.8, "smoothing_n_per_mm": 1.8, "deviation": 5},
    {"bump_n": 1.5, "none_n_per_mm": 0.5, "smoothing_n_per_mm": 1.5, "deviation": 5},
    {"bump_n": 2.0, "none_n_per_mm": 0.4, "smoothing_n_per_mm": 1.6, "deviation": 9}])"));
  EXPECT_EQ(report.csv,
            "bump_n,none_n_per_mm,smoothing_n_per_mm,deviation\n0.5,1,1.5,10\n1,0.8,1.8,5\n1.5,0.5,1.5,5\n2,"
            "0.4,1.6,9\n");
  EXPECT_THAT(report.text, HasSubstr("bump  1.0 N: 0.8 and 1.8 N/mm\nbump  1.5 N: 0.5 and 1.5 N/mm  fitted\n"
                                     "bump  2.0 N: 0.4 and 1.6 N/mm\nfitted: 1.5 N\n"));
  const std::vector<std::vector<std::string>> table = {{"0.5", "1.0", "1.5", "10"},
                                                       {"1.0", "0.8", "1.8", "5"},
                                                       {"1.5", "0.5", "1.5", "5"},
                                                       {"2.0", "0.4", "1.6", "9"}};
  EXPECT_EQ(report.sections.at(0).table.rows, table);
  EXPECT_EQ(report.sections.at(0).text.at(1), "Fitted: 1.5 N.");
}

// It is frozen in the scenes: whoever changes device, patient or criterion has to fit again, and to say so.
TEST(SoakS2Fit, FindsTheBumpThatTheScenesHave) {
  const auto json = nlohmann::json::parse(s2_fit().json);
  for (const char* scene : {"stability_press", "stability_grasp"})
    EXPECT_EQ(json["fitted_bump_n"].get<double>(), load_patient(load_scene(scene)).bump) << scene;
}

}  // namespace
}  // namespace phalanx
