// SPDX-License-Identifier: Apache-2.0
// How often the oscillation observer takes a patient's own tremor for an oscillation: the false stops of a
// station.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "study/experiments/loop_run.h"
#include "study/experiments/s2_experiments.h"

namespace phalanx {
namespace {

/// Trials of 20 seeds in which the observer fired before the release, and those that are stable.
struct Count {
  int fired = 0;
  int stable = 0;
};

Count count_fired(const char* stiffness, const char* bound, double tremor_um) {
  const LoopRun run = run_loop("tremor", "stability_press",
                               {{"force.stiffness_n_per_mm", stiffness},
                                {"smoothing.min_n", fmt::format("-{}", bound)},
                                {"smoothing.max_n", bound},
                                {"patient.bump_n", "0"},
                                {"patient.tremor_um", fmt::format("{}", tremor_um)}},
                               kLoopSeeds);
  return {.fired = static_cast<int>(std::count_if(run.detections.begin(), run.detections.end(),
                                                  [](const Detection& d) { return !std::isnan(d.fired_s); })),
          .stable = run.stable()};
}

// 30 um at the fingertip, 5 to 12 Hz, is the patient's default; an essential tremor of the finger is some
// millimetres. No bump: a force that swings beyond 0.5 N is then the tremor's. The table is the one of
// docs/safety.md.
TEST(TremorStops, APatientsOwnTremorOfUpToThreeTenthsOfAMillimetreIsNoOscillation) {
  for (const auto& [stiffness, bound] :
       {std::pair{"0.5", "0.1"}, std::pair{"0.9", "0.05"}, std::pair{"1.4", "0.1"}}) {
    for (const double tremor_um : {0.0, 30.0, 100.0, 300.0, 1000.0, 3000.0}) {
      const Count count = count_fired(stiffness, bound, tremor_um);
      std::printf("%s N/mm, %s N a step, tremor %.0f um: fired in %d of %d, stable %d\n", stiffness, bound,
                  tremor_um, count.fired, kLoopSeeds, count.stable);
      if (tremor_um <= 300.0 && stiffness != std::string("1.4")) {
        EXPECT_EQ(count.fired, 0) << stiffness << " N/mm, " << tremor_um << " um";
      }
    }
  }
}

}  // namespace
}  // namespace phalanx
