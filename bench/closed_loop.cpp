// SPDX-License-Identifier: Apache-2.0
// phalanx_bench_loop: how many times faster than real time the simulated exoskeleton and the closed loop run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>

#include "expected_hashes.h"
#include "force_hash.h"
#include "phalanx/record/made.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/patient_file.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"
#include "phalanx/simulation/plant.h"
#include "stopwatch.h"

namespace phalanx::bench {
namespace {

constexpr int kRepeats = 5;
constexpr const char* kDevice = "beihang";
constexpr const char* kScene = "press_teapot";

/// The best of kRepeats runs of the same thing.
struct Timed {
  double seconds = std::numeric_limits<double>::infinity();  ///< of wall time
  std::uint64_t hash = 0;
};

/// @param run  does the work once and returns the hash of what came out
/// @throws std::runtime_error if it is not the same every time.
template <class Run>
Timed best_of_repeats(const std::string& what, const Run& run) {
  Timed timed;
  for (int i = 0; i < kRepeats; ++i) {
    const Stopwatch watch;
    const std::uint64_t hash = run();
    timed.seconds = std::min(timed.seconds, 1e-6 * watch.us());
    if (i > 0 && hash != timed.hash)
      throw std::runtime_error(
          fmt::format("{}: two runs gave different results; it is not deterministic", what));
    timed.hash = hash;
  }
  return timed;
}

constexpr int kPlantTicks = 10000;  ///< of 1 ms

/// All joints swing and all motors pull to and fro, so that everything sticks, slips and crosses its play.
std::uint64_t run_plant(const Exoskeleton& exo, const PatientParameters& patient) {
  Plant plant(exo, patient, {});
  PlantInput input;
  input.motor_force.assign(exo.motors.size(), 0.0);
  Hash hash;
  for (int i = 0; i < kPlantTicks; ++i) {
    const double t = 1e-3 * i;
    for (std::size_t m = 0; m < exo.motors.size(); ++m)
      input.motor_force[m] = 0.15 * exo.motors[m].force_limit * std::sin(9.0 * t + static_cast<double>(m));
    input.intended.fill(0.2 * std::sin(4.0 * t));
    plant.advance(input, 1e-3);
    for (const double q : plant.angle()) hash.add(q);
  }
  hash.add(plant.energy().turned_over);
  return hash.value();
}

/// @throws std::runtime_error if the finger does not press.
std::uint64_t run_whole_trial(const TrialSetup& setup, double stiffness) {
  Hash hash;
  constexpr double kOwn =
      std::numeric_limits<double>::quiet_NaN();  // the scene's stiffness, the patient's press
  const TrialResult result = run_trial(
      setup, stiffness, kOwn, 1,
      [&hash](double, const Snapshot& snapshot, const SimulatedExoskeleton&) { hash.add(snapshot); });
  if (!(result.mean_force > 0.1))
    throw std::runtime_error(fmt::format(
        "trial: the finger presses with {} N; nothing was timed that matters", result.mean_force));
  hash.add(result.force_swing);
  hash.add(result.mean_force);
  return hash.value();
}

/// @throws std::runtime_error if the results are on record and these are others.
const char* check(ExpectedHashes& expected, const std::string& name, int ticks, std::uint64_t hash,
                  bool record) {
  if (record) {
    expected.set(name, ticks, hash);
    return "recorded";
  }
  const auto wanted = expected.find(name, ticks);
  if (!wanted) return "not on record";
  if (*wanted == hash) return "as on record";
  throw std::runtime_error(
      fmt::format("{}: the results' hash is {:016x}, {:016x} was expected; if they were meant "
                  "to change, run with --record and say so in the changelog",
                  name, hash, *wanted));
}

void print_row(const std::string& what, double simulated, const Timed& timed, const char* known) {
  fmt::print("| {} | {:.2f} s | {:.1f} ms | {:.0f}x | {:016x}, {} |\n", what, simulated, 1e3 * timed.seconds,
             simulated / timed.seconds, timed.hash, known);
}

void run(bool record) {
  const Made made = made_here();
  fmt::print("phalanx_bench_loop {} on {}, {}, {}; one thread, the best of {} runs\n\n", made.commit,
             made.cpu, made.compiler, made.build_type, kRepeats);
  ExpectedHashes expected(PHALANX_BENCH_FOLDER "/expected_hashes.txt");
  fmt::print("| what | simulated | took | of real time | hash |\n|---|---|---|---|---|\n");

  const Exoskeleton exo = load_device_file(kDevice);
  const PatientParameters patient = load_patient_file("adult");
  const Timed plant = best_of_repeats("plant", [&] { return run_plant(exo, patient); });
  const std::string plant_name = fmt::format("plant_{}", kDevice);
  print_row("plant alone, 8 motors", 1e-3 * kPlantTicks, plant,
            check(expected, plant_name, kPlantTicks, plant.hash, record));

  const Stopwatch watch;
  const auto setup = make_trial_setup(load_scene(kScene));
  const double set_up = 1e-6 * watch.us();
  const double simulated = setup->schedule.end;
  const int ticks = static_cast<int>(std::lround(simulated * setup->parameters.rate_hz));
  double trial_seconds = 0.0;
  for (const int stiffness : {900, 3000}) {
    const std::string name = fmt::format("trial_{}_{}", kScene, stiffness);
    const Timed trial = best_of_repeats(name, [&] { return run_whole_trial(*setup, stiffness); });
    print_row(fmt::format("closed loop: plant, sensing, haptic step; a trial at {} N/m", stiffness),
              simulated, trial, check(expected, name, ticks, trial.hash, record));
    trial_seconds = std::max(trial_seconds, trial.seconds);
  }
  fmt::print(
      "\n20 trials, a study's step in search of a limit: {:.2f} s on one thread; and {:.2f} s to set the "
      "scene up, once.\n",
      20.0 * trial_seconds, set_up);
  if (record) expected.save();
}

}  // namespace
}  // namespace phalanx::bench

int main(int argc, char** argv) {
  const bool record = argc == 2 && std::string(argv[1]) == "--record";
  if (argc > 1 && !record) {
    fmt::print(stderr,
               "phalanx_bench_loop [--record]   --record: write this run's hashes to expected_hashes.txt\n");
    return 2;
  }
  try {
    phalanx::bench::run(record);
  } catch (const std::exception& error) {
    fmt::print(stderr, "phalanx_bench_loop: {}\n", error.what());
    return 1;
  }
  return 0;
}
