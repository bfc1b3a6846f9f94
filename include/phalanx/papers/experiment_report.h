// SPDX-License-Identifier: Apache-2.0
// The result of an experiment, and the list of experiments by name.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "phalanx/papers/experiments_report.h"

namespace phalanx {

/// Result of an experiment, in all its forms.
struct ExperimentReport {
  std::string text;                     ///< for a terminal
  std::string csv;                      ///< NAME.csv
  std::string json;                     ///< summary.json
  std::string svg;                      ///< NAME.svg, the figure in the paper's form; empty: none
  std::vector<PaperRow> rows;           ///< the paper's numbers beside ours
  std::vector<ReportSection> sections;  ///< for the page of `phalanx experiment all`
};

/// One experiment of the papers.
struct Experiment {
  std::string name;  ///< "s2-fig4"
  std::string help;  ///< one line
  /// Processor time, summed over all cores, on the machine of README's timings [s].
  double processor_seconds = 0.0;
  bool all_cores = false;  ///< the experiment uses all cores
  std::function<ExperimentReport()> run;
};

/// @returns all experiments, in the order in which `phalanx experiment all` runs them.
[[nodiscard]] const std::vector<Experiment>& experiments();

}  // namespace phalanx
