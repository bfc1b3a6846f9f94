// SPDX-License-Identifier: Apache-2.0
// The papers' experiments, run by the program's own step: their list, their results, and the page that
// compares the papers' numbers with ours. Results are compared only with what the papers print. S1 is Feng,
// Li, IEEE ROBIO 2010, and S2 is Feng, Li, Zheng, ICVRV 2011 (docs/architecture.md).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "phalanx/record/made.h"

namespace phalanx {

/// Origin of one of our numbers.
enum class RowKind {
  kFitted,     ///< a parameter was chosen for agreement: agreement proves nothing
  kPredicted,  ///< computed with frozen parameters before the comparison
  kMeasured,   ///< measured on the program itself: a time, a count
};
[[nodiscard]] const char* row_kind_name(RowKind kind) noexcept;  ///< "fitted", "predicted", "measured"

/// One number of a paper and ours.
struct PaperRow {
  std::string experiment;  ///< "s2-limit"
  std::string quantity;
  std::string unit;        ///< may be empty
  std::string paper;       ///< empty: shown as "not printed"
  std::string ours;        ///< empty: shown as "not run"
  std::string difference;  ///< may be empty
  RowKind kind = RowKind::kMeasured;
  std::string note;
};

/// A table of a report.
struct ReportTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A section of a report.
struct ReportSection {
  std::string title;
  std::vector<std::string> text;  ///< paragraphs
  std::vector<std::string> svg;   ///< whole SVG documents, as chart.h returns them; shown one below the other
  ReportTable table;              ///< left out if it has neither header nor rows
};

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

/// Writes one HTML page that needs no other file: the table of all rows, the sections, and
/// commit and machine.
/// @param seeds  in words: "1 to 20"; empty: left out
/// All text is escaped; only `svg` is inserted unchanged.
[[nodiscard]] std::string experiments_html(const std::vector<PaperRow>& rows,
                                           const std::vector<ReportSection>& sections, const Made& made,
                                           const std::string& seeds = "");

}  // namespace phalanx
