// SPDX-License-Identifier: Apache-2.0
// `phalanx study` as its users meet it, as far as that needs no closed loop.
#include <gmock/gmock.h>

#include "apps/run_program.h"
#include "phalanx/record/output_file.h"
#include "phalanx/study/laboratory/outputs.h"
#include "study/laboratory/synthetic.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::run_program;
using testing::TemporaryFolder;
using testing::write_file;

constexpr const char* kStudy = R"(
scene = "press_teapot"
seeds = 2
[stiffness]
min_n_per_mm = 0.5
max_n_per_mm = 1.0
step_n_per_mm = 0.1
[[axis]]
key = "device.scale.sheath_friction"
label = "sheath friction"
values = [0, 1]
)";

TEST(CliStudy, ChecksAStudyWithoutRunningIt) {
  const TemporaryFolder folder;
  write_file(folder / "s.toml", kStudy);
  const auto result = run_program(folder, "study check s.toml");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("    1  sheath friction 1\n"));
  EXPECT_THAT(result.out, HasSubstr("s: 2 points of 2 seeds; at most 16 trials a point and 32 in all"));
}

TEST(CliStudy, RefusesAnUnknownKeyBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  write_file(folder / "s.toml",
             "scene = \"press_teapot\"\n[[axis]]\nkey = \"force.lw\"\nvalues = [\"hooke\"]\n");
  for (const char* command : {"study check s.toml", "study s.toml --out o"}) {
    const auto result = run_program(folder, command);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("force.law"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST(CliStudy, RefusesWrongUsageInOneLine) {
  const TemporaryFolder folder;
  write_file(folder / "s.toml", kStudy);
  for (const char* arguments :
       {"", "s.toml", "none.toml --out o", "s.toml --out o --shard 3/2", "s.toml --out o --jobs 0",
        "s.toml --out \"\"", "merge --out o", "merge . --out o", "check"}) {
    const auto result = run_program(folder, std::string("study ") + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << arguments << ": " << result.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "o"));
}

TEST(CliStudy, StandardErrorOnAFullDiskChangesNothing) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const TemporaryFolder folder;
  write_file(folder / "s.toml", "scene = \"index_ball\"\nseeds = 1\n");
  const auto result = run_program(folder, "study s.toml --out o 2>/dev/full");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "o" / "summary.json"));
}

TEST(CliStudy, MergesShards) {
  const TemporaryFolder folder;
  const Study study = testing::study_of(testing::kTwelvePoints);
  for (const int index : {1, 2}) {
    StudyOptions options = testing::options_for(2);
    options.shard = {.index = index, .count = 2};
    static_cast<void>(run_study(study, testing::no_inputs, testing::synthetic_trial,
                                folder / std::to_string(index), options));
  }
  const auto result = run_program(folder, "study merge 1 2 --out all");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("smoothing, friction 0.2: k_lim 2.5 N/mm\n"));
  EXPECT_THAT(result.out, HasSubstr("k_lim at least 4 N/mm\n"));
  for (const char* file : {"points.jsonl", "study.csv", "summary.json", "report.html"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path() / "all" / file)) << file;
}

}  // namespace
}  // namespace phalanx
