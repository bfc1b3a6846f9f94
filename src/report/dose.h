// SPDX-License-Identifier: Apache-2.0
// Sums of what a patient has done: by day, by week, in all.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "phalanx/registry/result.h"
#include "phalanx/registry/result_detail.h"

namespace phalanx::report {

/// What the details of rows state, each read once.
using RowDetails = std::map<const ResultRow*, ResultDetail>;
using RowPointers = std::span<const ResultRow* const>;

/// Exercises of some time, added up. All rows count, also interrupted and invalid ones: it is the dose.
struct Dose {
  double begin = 0.0;  ///< of the day or week, UTC [s since 1970]
  int days = 0;        ///< with an exercise
  int exercises = 0;   ///< rows
  int trials = 0;      ///< ResultRow::repetitions, of all exercises
  int trainings = 0;   ///< valid rows of trainings
  int counted = 0;     ///< trials of these that were scored
  int successes = 0;   ///< of `counted`
  double seconds = 0.0;
  int incomplete = 0;                   ///< rows that are interrupted or not valid
  int pain = -1;                        ///< largest one; -1: never asked
  int fatigue = -1;                     ///< likewise
  std::vector<std::string> names = {};  ///< of the exercises, each once, in the order of their first row
};

/// @returns the doses of the days with an exercise, by date. @param rows  by date, each with its detail
[[nodiscard]] std::vector<Dose> dose_by_day(RowPointers rows, const RowDetails& details);
/// @returns the doses of all weeks from the first to the last exercise, also of weeks without one
[[nodiscard]] std::vector<Dose> dose_by_week(RowPointers rows, const RowDetails& details);
/// @returns the dose of all rows
[[nodiscard]] Dose whole_dose(RowPointers rows, const RowDetails& details);
/// @returns true if the row is complete and valid
[[nodiscard]] inline bool is_complete(const ResultRow& row) noexcept { return row.valid && !row.interrupted; }

}  // namespace phalanx::report
