// SPDX-License-Identifier: Apache-2.0
// What `phalanx experiment` writes for the closed-loop experiments.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/run_program.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::read_file;
using testing::run_program;
using testing::TemporaryFolder;

TEST(CliClosedLoopExperiment, WritesNumbersCurvesAndFigure) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "experiment s2-fig4 --out a");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, IsEmpty());
  EXPECT_THAT(result.out, HasSubstr("stable in 20 of 20 seeds"));
  const auto summary = nlohmann::json::parse(read_file(folder / "a/summary.json"));
  EXPECT_EQ(summary["experiment"], "s2-fig4");
  EXPECT_EQ(summary["smoothing"]["stable_seeds"], 20);
  const std::string csv = read_file(folder / "a/s2-fig4.csv");
  EXPECT_THAT(csv, ::testing::StartsWith("run,time_s,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 1060);  // two runs of 5.3 s at 200 Hz
  EXPECT_THAT(read_file(folder / "a/s2-fig4.svg"), HasSubstr("</svg>"));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "a"))
    EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
}

}  // namespace
}  // namespace phalanx
