// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/closed_loop/trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "phalanx/scene/scene_file.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/simulated_exoskeleton.h"
#include "phalanx/study/trial_function.h"
#include "record/temporary_folder.h"
#include "support/opened_files.h"

namespace phalanx {
namespace {

constexpr double kAsItIs = std::numeric_limits<double>::quiet_NaN();

void expect_same_bits(const TrialResult& a, const TrialResult& b) {
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_EQ(a.why_invalid, b.why_invalid);
  EXPECT_EQ(a.stable, b.stable);
  EXPECT_EQ(a.force_swing, b.force_swing);
  EXPECT_EQ(a.position_swing, b.position_swing);
  EXPECT_EQ(a.peak_depth, b.peak_depth);
  EXPECT_EQ(a.mean_force, b.mean_force);
  EXPECT_EQ(a.mean_depth, b.mean_depth);
  EXPECT_EQ(a.ghost_s, b.ghost_s);
  EXPECT_EQ(a.ghost_energy, b.ghost_energy);
}

TEST(Trial, OpensEachFileOnceForItsSetup) {
  const testing::TemporaryFolder folder;
  const SceneDescription scene =
      SceneFile(test::write_first_touch(folder.path())).scene({{"patient.bump_n", "0"}});
  const test::OpenedFiles opened(folder.path());
  EXPECT_FALSE(make_trial_setup(scene)->model.object.mesh().triangles.empty());
  const std::map<std::string, int> once = {{"device.toml", 1}, {"hand.toml", 1}, {"patient.toml", 1}};
  EXPECT_EQ(opened.take(), once);
}

TEST(Trial, OpensEachFileOnceForAllTrialsOfAScene) {
  const testing::TemporaryFolder folder;
  const std::string scene = test::write_first_touch(folder.path());
  const test::OpenedFiles opened(folder.path());
  const TrialFunction trial = make_trial_function(scene);
  for (const std::uint64_t seed : {1U, 2U})
    static_cast<void>(trial({{"patient.bump_n", "0"}}, kAsItIs, kAsItIs, seed));
  const std::map<std::string, int> once = {
      {"device.toml", 1}, {"hand.toml", 1}, {"patient.toml", 1}, {"scene.toml", 1}};
  EXPECT_EQ(opened.take(), once);
}

TEST(Trial, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const auto setup = make_trial_setup(load_scene("stability_press"));
  const TrialResult first = run_trial(*setup, kAsItIs, kAsItIs, 3);
  const TrialResult other = run_trial(*setup, kAsItIs, kAsItIs, 4);
  expect_same_bits(first, run_trial(*setup, kAsItIs, kAsItIs, 3));
  EXPECT_NE(first.mean_force, other.mean_force);
  EXPECT_GT(first.mean_force, 1.0);
}

TEST(Trial, IsTheSameInTwoThreadsAtOnce) {
  const auto setup = make_trial_setup(load_scene("stability_press"));
  const TrialResult alone = run_trial(*setup, kAsItIs, kAsItIs, 1);
  std::vector<TrialResult> beside(2);
  {
    std::jthread one([&] { beside[0] = run_trial(*setup, kAsItIs, kAsItIs, 1); });
    std::jthread two([&] { beside[1] = run_trial(*setup, kAsItIs, kAsItIs, 1); });
  }
  expect_same_bits(alone, beside[0]);
  expect_same_bits(alone, beside[1]);
}

// A trial is judged from 2.7 s on: a bump from 2.2 s on may last 500 ms, and no longer.
TEST(Trial, IsNotJudgedWhileTheBumpLasts) {
  const auto set_up = [](const char* newtons, const char* milliseconds) {
    return make_trial_setup(load_scene("stability_press", {{"patient.bump_n", newtons},
                                                           {"patient.bump_start_s", "2.2"},
                                                           {"patient.bump_duration_ms", milliseconds}}));
  };
  EXPECT_EQ(set_up("1", "500")->patient.bump, 1.0);
  EXPECT_THROW(static_cast<void>(set_up("1", "501")), std::invalid_argument);
  EXPECT_EQ(set_up("0", "501")->patient.bump, 0.0) << "there is none";
}

TEST(Trial, RefusesAStiffnessOrAPressOutOfRange) {
  const auto setup = make_trial_setup(load_scene("stability_press"));
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double stiffness : {0.0, -1.0, infinity})
    EXPECT_THROW(static_cast<void>(run_trial(*setup, stiffness, kAsItIs, 1)), std::invalid_argument)
        << stiffness;
  for (const double press : {-0.1, infinity})
    EXPECT_THROW(static_cast<void>(run_trial(*setup, kAsItIs, press, 1)), std::invalid_argument) << press;
}

// The scene says 0.9 N/mm, the patient 3 N.
TEST(Trial, TakesTheScenesStiffnessAndThePatientsPressForNaN) {
  const auto setup = make_trial_setup(load_scene("stability_press"));
  const TrialResult as_it_is = run_trial(*setup, kAsItIs, kAsItIs, 2);
  expect_same_bits(as_it_is, run_trial(*setup, 900.0, 3.0, 2));
  EXPECT_NE(as_it_is.mean_depth, run_trial(*setup, 800.0, kAsItIs, 2).mean_depth);
  EXPECT_NE(as_it_is.mean_force, run_trial(*setup, kAsItIs, 2.0, 2).mean_force);
}

// A trial has parameters of its own, and no copy of the model: that does not compile.
TEST(Trial, SharesTheSetUpsModel) {
  static_assert(!std::is_copy_constructible_v<HapticModel> && !std::is_copy_constructible_v<TrialSetup>);
  const auto setup = make_trial_setup(load_scene("stability_press"));
  const TrialResult first = run_trial(*setup, kAsItIs, kAsItIs, 2);
  EXPECT_NE(first.mean_depth, run_trial(*setup, 800.0, kAsItIs, 2).mean_depth);
  EXPECT_EQ(setup->parameters.force.stiffness, 900.0) << "the scene's";
  expect_same_bits(first, run_trial(*setup, kAsItIs, kAsItIs, 2));
}

// A finger that rests on two facets, with the patient's tremor. Where recoveries of the working clearance do not
// move the springs of friction along, it creeps along the teapot, and its force changes by 0.14 and 0.2 N.
TEST(Trial, AFingerThatRestsDoesNotCreep) {
  const auto setup = make_trial_setup(load_scene(
      "stability_press",
      {{"contact.mode", "\"sliding\""}, {"device.file", "\"light\""}, {"stabiliser.method", "\"none\""}}));
  for (const std::uint64_t seed : {1U, 2U}) {
    const TrialResult result = run_trial(*setup, 400.0, kAsItIs, seed);
    EXPECT_TRUE(result.valid && result.stable) << seed << " " << result.why_invalid;
    EXPECT_LT(result.force_swing, 0.08) << seed;
  }
}

TEST(Trial, ShowsEveryStepOfTheHostInOrder) {
  const auto setup = make_trial_setup(load_scene("stability_press"));
  std::vector<double> times;
  double torque = 0.0;
  (void)run_trial(*setup, kAsItIs, kAsItIs, 5,
                  [&](double t, const Snapshot&, const SimulatedExoskeleton& device) {
                    times.push_back(t);
                    for (const double of_joint : device.rendered().torque)
                      torque = std::max(torque, std::abs(of_joint));
                  });
  ASSERT_NEAR(static_cast<double>(times.size()), setup->schedule.end * setup->parameters.rate_hz, 1.0);
  EXPECT_NEAR(times.front(), clock_phase(5) / setup->parameters.rate_hz, 1e-12);
  for (std::size_t i = 1; i < times.size(); ++i)
    ASSERT_NEAR(times[i] - times[i - 1], 1.0 / setup->parameters.rate_hz, 1e-9);
  EXPECT_GT(torque, 0.01);
}

// What ran before, with other overrides, changes nothing.
TEST(TrialFunction, GivesWhatTheTrialGivesWhateverRanBefore) {
  const TrialFunction trial = make_trial_function("stability_press");
  const Overrides none = {{"stabiliser.method", "\"none\""}};
  const TrialResult first = trial(none, 500.0, kAsItIs, 1);
  const TrialResult as_it_is = trial({}, kAsItIs, kAsItIs, 1);
  expect_same_bits(first, trial(none, 500.0, kAsItIs, 1));
  expect_same_bits(first,
                   run_trial(*make_trial_setup(load_scene("stability_press", none)), 500.0, kAsItIs, 1));
  expect_same_bits(as_it_is,
                   run_trial(*make_trial_setup(load_scene("stability_press")), kAsItIs, kAsItIs, 1));
  EXPECT_NE(first.mean_depth, as_it_is.mean_depth);
}

TEST(TrialFunction, RefusesWhatTheSceneRefuses) {
  const TrialFunction trial = make_trial_function("stability_press");
  EXPECT_THROW((void)trial({{"force.stifness_n_per_mm", "1"}}, kAsItIs, kAsItIs, 1), SceneError);
  EXPECT_THROW((void)make_trial_function("no_such_scene")({}, kAsItIs, kAsItIs, 1), SceneError);
}

}  // namespace
}  // namespace phalanx
