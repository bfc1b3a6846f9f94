// SPDX-License-Identifier: Apache-2.0
// What `phalanx experiment` says about itself.
#include <gmock/gmock.h>

#include "apps/run_program.h"
#include "phalanx/papers/experiments.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::run_program;
using testing::TemporaryFolder;

TEST(CliExperimentHelp, NamesEveryExperimentAndAll) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "experiment --help");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const Experiment& experiment : experiments()) EXPECT_THAT(result.out, HasSubstr(experiment.name));
  for (const char* name : {"s1-fig8", "s2-fit", "s2-fig4", "s2-fig5", "s2-limit", "s2-sensitivity"})
    EXPECT_THAT(result.out, HasSubstr(name));
}

TEST(CliExperimentHelp, SaysWhereThePageOfAllGoes) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "experiment all --help");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("--out"));
  EXPECT_THAT(result.out, HasSubstr("out/experiments"));
}

TEST(CliExperimentHelp, RefusesAnExperimentThatThereIsNot) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, "experiment s2-fig6");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("s2-fig6"));
}

}  // namespace
}  // namespace phalanx
