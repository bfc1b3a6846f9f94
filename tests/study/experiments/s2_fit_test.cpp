// SPDX-License-Identifier: Apache-2.0
// The one number that is fitted.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "phalanx/scene/patient_file.h"
#include "study/experiments/s2_experiments.h"

namespace phalanx {
namespace {

// It is frozen in the scenes: whoever changes device, patient or criterion has to fit again, and to say so.
TEST(SoakS2Fit, FindsTheBumpThatTheScenesHave) {
  const auto json = nlohmann::json::parse(s2_fit().json);
  for (const char* scene : {"stability_press", "stability_grasp"})
    EXPECT_EQ(json["fitted_bump_n"].get<double>(), load_patient(load_scene(scene)).bump) << scene;
}

}  // namespace
}  // namespace phalanx
