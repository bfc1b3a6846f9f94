// SPDX-License-Identifier: Apache-2.0
// What an experiment comes to, and the experiments by name.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "phalanx/study/report/experiments_report.h"

namespace phalanx {

struct ExperimentReport {
  std::string text;                     ///< for a terminal
  std::string csv;                      ///< NAME.csv
  std::string json;                     ///< summary.json
  std::string svg;                      ///< NAME.svg, the figure in the paper's form; empty if there is none
  std::vector<PaperRow> rows;           ///< paper beside ours
  std::vector<ReportSection> sections;  ///< of the page that `phalanx experiment all` makes
};

struct Experiment {
  std::string name;  ///< "s2-fig4"
  std::string help;  ///< one line
  /// How long it keeps processors busy, all together, on the machine of README's timings [s].
  double processor_seconds = 0.0;
  bool all_cores = false;  ///< it is shared by all cores
  std::function<ExperimentReport()> run;
};

/// In the order in which `phalanx experiment all` runs them.
[[nodiscard]] const std::vector<Experiment>& experiments();

}  // namespace phalanx
