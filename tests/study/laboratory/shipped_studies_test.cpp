// SPDX-License-Identifier: Apache-2.0
// Every study that ships can be read, and every one of its points can be set up.
#include <gtest/gtest.h>

#include <filesystem>

#include "phalanx/study/laboratory/run_study.h"
#include "phalanx/study/laboratory/scene_inputs.h"
#include "phalanx/study/laboratory/study_file.h"

namespace phalanx {
namespace {

TEST(ShippedStudies, CanBeReadAndAllTheirPointsSetUp) {
  int studies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PHALANX_SOURCE_DIR "/studies")) {
    const Study study = load_study(entry.path());
    EXPECT_NO_THROW(static_cast<void>(check_study(study, scene_check(study)))) << entry.path();
    EXPECT_GE(study.seeds, 10) << entry.path();
    ++studies;
  }
  EXPECT_GE(studies, 3);
}

}  // namespace
}  // namespace phalanx
