// SPDX-License-Identifier: Apache-2.0
// Uses phalanx::simulation as installed: plays an installed scene's motion into arrays, and runs a trial of the
// closed loop with the installed device and patient.
#include <cstdio>
#include <exception>
#include <limits>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"
#include "phalanx/simulation/simulate.h"

int main() try {
  const phalanx::SceneDescription scene = phalanx::load_scene("press_teapot");
  const phalanx::HapticModel model = phalanx::build_model(scene);
  const phalanx::Motion motion = phalanx::build_motion(scene);
  const std::uint64_t ticks = phalanx::tick_count(1.5, scene.parameters.rate_hz);
  const phalanx::SimulatedMotion played = phalanx::simulate_motion(model, scene.parameters, motion, ticks);
  double largest = 0.0;
  for (const phalanx::SegmentArray& forces : played.force)
    for (const double force : forces) largest = force > largest ? force : largest;

  constexpr double kAsSetUp = std::numeric_limits<double>::quiet_NaN();
  const auto setup = phalanx::make_trial_setup(phalanx::load_scene("stability_press"));
  const phalanx::TrialResult trial = phalanx::run_trial(*setup, 400.0, kAsSetUp, 1);
  std::printf("%zu steps, largest force %.3f N; trial at 0.4 N/mm: %s, %.3f N\n", played.torque.size(),
              largest, trial.stable ? "stable" : "not stable", trial.mean_force);
  return played.torque.size() == ticks && largest > 0.1 && trial.valid && trial.stable ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
