// SPDX-License-Identifier: Apache-2.0
// The files of a finished study, and putting shards together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// study.csv: a header with units, then one row a point: the values of variant and axes, then the results.
/// What is not there is an empty field. RFC 4180.
/// @param results  in the order of the points
[[nodiscard]] std::string study_csv(const Study& study, const std::vector<PointResult>& results);

/// summary.json: the same with every checked stiffness, the study itself, and where it was made.
[[nodiscard]] std::string study_summary_json(const Study& study, const std::vector<PointResult>& results,
                                             const Made& made);

/// Writes study.csv and, last, summary.json into `out`: a folder that has it is complete. @throws
/// std::runtime_error if one cannot be written.
void write_study_outputs(const std::filesystem::path& out, const Study& study,
                         const std::vector<PointResult>& results, const Made& made);

/// Removes study.csv, summary.json and report.html of an earlier run, which would contradict a journal that
/// is being written.
void remove_study_outputs(const std::filesystem::path& out);

struct MergedStudy {
  Study study;  ///< as the journals have it; `folder` is empty
  std::vector<PointResult> results;
};

/// Puts the journals (points*.jsonl) of `folders` together, and what is in `out` already; writes
/// `out`/points.jsonl, by which the study can be taken up as if it had never been in parts.
/// @throws std::invalid_argument naming the file if a folder holds no journal, journals are of different
/// studies, inputs
///         or programs, or a point has different results in two of them; or listing the points that are
///         missing. Nothing is written then.
[[nodiscard]] MergedStudy merge_studies(const std::vector<std::filesystem::path>& folders,
                                        const std::filesystem::path& out);

}  // namespace phalanx
