// SPDX-License-Identifier: Apache-2.0
// The files of a finished study, and the merging of shards.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Writes study.csv: a header with units, then one row a point with the values of variant and axes, and the
/// results. A missing value is an empty field. RFC 4180.
/// @param results  in the order of the points
[[nodiscard]] std::string study_csv(const Study& study, const std::vector<PointResult>& results);

/// Writes summary.json: the same with every checked stiffness, the study itself, and the commit and machine.
[[nodiscard]] std::string study_summary_json(const Study& study, const std::vector<PointResult>& results,
                                             const Made& made);

/// Writes study.csv and then summary.json into `out`: a folder with summary.json is complete.
/// @throws std::runtime_error if a file cannot be written.
void write_study_outputs(const std::filesystem::path& out, const Study& study,
                         const std::vector<PointResult>& results, const Made& made);

/// Removes study.csv, summary.json and report.html of an earlier run, which would contradict a journal that
/// is being written.
void remove_study_outputs(const std::filesystem::path& out);

/// A study that was put together from shards.
struct MergedStudy {
  Study study;  ///< as in the journals; `folder` is empty
  std::vector<PointResult> results;
};

/// Merges the journals (points*.jsonl) of `folders` with those already in `out`, and writes
/// `out`/points.jsonl. The study can then be continued as if it had never been split.
/// @throws std::invalid_argument naming the file if a folder holds no journal, or if journals are of
/// different studies, inputs or programs, or of machines whose mathematical functions round differently. It also
/// throws if a point has different results in two of them, or with a list of missing points. Nothing is written
/// then.
[[nodiscard]] MergedStudy merge_studies(const std::vector<std::filesystem::path>& folders,
                                        const std::filesystem::path& out);

}  // namespace phalanx
