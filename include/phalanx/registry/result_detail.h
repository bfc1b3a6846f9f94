// SPDX-License-Identifier: Apache-2.0
// What a result's detail, the recorded result as JSON, states beyond the fields of its row.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "phalanx/registry/result.h"

namespace phalanx {

/// Beginning of the codes of simulated patients. Only they may have results of a simulated participant, and
/// they have no other ones.
inline constexpr const char* kSimulatedCode = "SIM";
/// End of ResultConditions::device if a simulated participant did the exercise.
inline constexpr std::string_view kSimulatedDevice = " (simulated participant)";

/// Trials that were not scored for one reason.
struct UnscoredTrials {
  std::string reason = {};
  int trials = 0;
};

/// Content of ResultRow::detail. A row without a readable detail gives what its own fields state.
struct ResultDetail {
  int counted = 0;         ///< trials that were scored; without a detail ResultRow::repetitions
  int pain = -1;           ///< largest rating, 0 .. 10; -1: not asked
  int fatigue = -1;        ///< likewise
  std::string ended = {};  ///< why the exercise ended, in words
  int invalid_trials = 0;  ///< trials that were not scored, with a reason
  std::vector<UnscoredTrials> reasons = {};  ///< of these, each once
};

/// Reads the detail of a row.
[[nodiscard]] ResultDetail result_detail(const ResultRow& row);

/// @returns ResultDetail::counted of a training: a row states only those that were carried out
[[nodiscard]] int counted_trials(const ResultRow& row);

}  // namespace phalanx
