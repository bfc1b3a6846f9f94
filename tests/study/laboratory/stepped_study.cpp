// SPDX-License-Identifier: Apache-2.0
// stepped_study OUT: the twelve synthetic points. Each trial waits for a byte on the standard input; who
// writes them decides how far the study comes, and kills it.
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <stdexcept>

#include "phalanx/study/laboratory/outputs.h"
#include "study/laboratory/synthetic.h"

int main(int argc, char** argv) {
  using namespace phalanx;
  try {
    if (argc != 2) throw std::invalid_argument("usage: stepped_study OUT");
    const Study study = phalanx::testing::study_of(phalanx::testing::kTwelvePoints);
    const auto trial = [](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
      char step = 0;
      if (::read(STDIN_FILENO, &step, 1) != 1) throw std::runtime_error("nobody steps it any more");
      return phalanx::testing::synthetic_trial(overrides, stiffness, press, seed);
    };
    const auto results =
        run_study(study, phalanx::testing::no_inputs, trial, argv[1], phalanx::testing::options_for(2));
    write_study_outputs(argv[1], study, results,
                        {.commit = "", .cpu = "", .compiler = "", .build_type = "", .date = ""});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stepped_study: %s\n", error.what());
    return 1;
  }
}
