// SPDX-License-Identifier: Apache-2.0
// slow_study OUT TRIAL_US: the twelve synthetic points, each trial as slow as asked for; somebody else kills
// it.
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>

#include "phalanx/study/laboratory/outputs.h"
#include "study/laboratory/synthetic.h"

int main(int argc, char** argv) {
  using namespace phalanx;
  try {
    if (argc != 3) throw std::invalid_argument("usage: slow_study OUT TRIAL_US");
    const std::chrono::microseconds pause(std::stoi(argv[2]));
    const Study study = phalanx::testing::study_of(phalanx::testing::kTwelvePoints);
    const auto trial = [pause](const Overrides& overrides, double stiffness, double press,
                               std::uint64_t seed) {
      std::this_thread::sleep_for(pause);
      return phalanx::testing::synthetic_trial(overrides, stiffness, press, seed);
    };
    const auto results =
        run_study(study, phalanx::testing::no_inputs, trial, argv[1], phalanx::testing::options_for(2));
    write_study_outputs(argv[1], study, results,
                        {.commit = "", .cpu = "", .compiler = "", .build_type = "", .date = ""});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "slow_study: %s\n", error.what());
    return 1;
  }
}
