// SPDX-License-Identifier: Apache-2.0
// Every scene that ships, felt through the simulated exoskeleton as it ships: stiffness, stabiliser and
// limits are the scene's own.
#include <gtest/gtest.h>

#include <tbb/parallel_for.h>

#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"

namespace phalanx {
namespace {

// Limits may act, as they do in a station; what counts is that nothing swings.
TEST(ShippedScenesInTheLoop, AreSteadyWithTheStabiliserThatTheyHave) {
  constexpr double kSceneAsItIs = std::numeric_limits<double>::quiet_NaN();
  constexpr std::uint64_t kSceneSeeds = 2;
  std::vector<std::string> names;
  for (const SceneInfo& scene : list_scenes())
    if (scene.name != "wave" && !scene.name.starts_with("bench_")) names.push_back(scene.name);
  ASSERT_GE(names.size(), 20U);
  std::mutex printing;
  tbb::parallel_for(std::size_t{0}, names.size(), [&](std::size_t i) {
    const auto setup = make_trial_setup(load_scene(names[i]));
    for (std::uint64_t seed = 1; seed <= kSceneSeeds; ++seed) {
      const TrialResult trial = run_trial(*setup, kSceneAsItIs, kSceneAsItIs, seed);
      const std::lock_guard lock(printing);
      EXPECT_TRUE(trial.stable) << names[i] << ", seed " << seed << ": " << trial.force_swing << " N, "
                                << 1e3 * trial.position_swing << " mm";
      EXPECT_GT(trial.mean_force, 0.3) << names[i] << ", seed " << seed;
    }
  });
}

}  // namespace
}  // namespace phalanx
