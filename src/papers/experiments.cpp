// SPDX-License-Identifier: Apache-2.0
#include "phalanx/papers/experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "papers/felt_stiffness.h"
#include "papers/s1_fig8.h"
#include "papers/s2_experiments.h"
#include "papers/timing.h"

namespace phalanx {
namespace {

/// @returns the number of situations in which exactly the joints that S1 names carry torque.
int situations_that_agree(const std::vector<Fig8Situation>& situations) {
  constexpr double kNone = 1e-12;  // [Nm]
  const auto agrees = [&](const Fig8Situation& situation) {
    for (int joint = 0; joint < 3; ++joint) {
      const int index = joint_index(static_cast<int>(Digit::kIndex), joint == 0 ? 0 : joint + 1);
      const bool loaded = std::abs(situation.held.torque[static_cast<std::size_t>(index)]) > kNone;
      if (loaded != carries_torque(situation, joint)) return false;
    }
    return true;
  };
  return static_cast<int>(std::count_if(situations.begin(), situations.end(), agrees));
}

ExperimentReport s1_fig8() {
  const auto situations = run_s1_fig8();
  const int agree = situations_that_agree(situations);
  const auto all = static_cast<int>(situations.size());
  ExperimentReport report;
  report.text = fig8_text(situations);
  report.csv = fig8_csv(situations);
  report.json = fig8_json(situations);
  report.rows = {{.experiment = "s1-fig8",
                  .quantity = "situations in which exactly these joints carry torque",
                  .unit = "",
                  .paper = "7 of 7",
                  .ours = fmt::format("{} of {}", agree, all),
                  .difference = agree == all ? "agrees" : "differs",
                  .kind = RowKind::kPredicted,
                  .note = "angles and torques are not printed"}};
  return report;
}

ExperimentReport timing(const TimingResult& result, const std::string& paper) {
  ExperimentReport report{.text = timing_text(result),
                          .csv = timing_csv(result),
                          .json = timing_json(result),
                          .svg = "",
                          .rows = {},
                          .sections = {}};
  for (const TimingRun& run : result.runs) {
    report.rows.push_back(
        {.experiment = result.name,
         .quantity = fmt::format("time of a step, mean, smoothing {}", run.smoothing ? "on" : "off"),
         .unit = "us",
         .paper = paper,
         .ours = fmt::format("{:.1f}", run.step_us.mean),
         .difference = "",
         .kind = RowKind::kMeasured,
         .note = fmt::format("p99.9 {:.0f} us; other machines, other collision search", run.step_us.p999)});
  }
  return report;
}

}  // namespace

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> kExperiments = {
      {"s1-fig8", "Seven situations of the index finger and a ball: which joints carry torque", 0.1, false,
       s1_fig8},
      {"s1-timing", "S1's 1,489 triangles: time of a step beside S1's 4.2 ms", 0.1, false,
       [] { return timing(run_s1_timing(), "4200"); }},
      {"s2-timing", "S2's 2,248 + 992 triangles: time of a step", 8.0, false,
       [] { return timing(run_s2_timing(), ""); }},
      {"s2-fit", "The one free parameter of the simulated patient, fitted on S2's two limits", 38.0, true,
       s2_fit},
      {"s2-fig4",
       "The index finger presses the teapot at 0.9 N/mm, without and with smoothing, in closed loop", 2.0,
       true, s2_fig4},
      {"s2-fig5", "A power grasp at 1.4 N/mm with smoothing, in closed loop", 4.0, true, s2_fig5},
      {"s2-limit", "The largest stable stiffness without and with smoothing, beside S2's 0.7 and 1.6 N/mm",
       43.0, true, s2_limit},
      {"s2-sensitivity", "What moves these two limits: friction, delay, the patient's stiffness, the bump",
       174.0, true, s2_sensitivity},
      {"felt-stiffness", "What each stabiliser costs in feel: the stiffness felt at a speed of approach", 0.1,
       false, felt_stiffness_experiment},
  };
  return kExperiments;
}

}  // namespace phalanx
