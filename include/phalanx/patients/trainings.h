// SPDX-License-Identifier: Apache-2.0
// The success of a patient's trainings: a therapist must be told of one that is not in its range
// after ten sessions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "phalanx/exercise/training.h"
#include "phalanx/registry/patient.h"
#include "phalanx/registry/result.h"

namespace phalanx {

/// @returns the past sessions of a training, oldest first
[[nodiscard]] std::vector<TrainingSession> training_history(std::span<const ResultRow> results,
                                                            const std::string& exercise);

/// Success of one training of a patient.
struct TrainingReport {
  std::string exercise = {};
  double target_success = 0.0;  ///< that it steers to [-]
  SuccessReport success = {};
  int sessions = 0;  ///< valid ones, in all

  /// @returns true if the last sessions were judged, and are not known to be in range
  [[nodiscard]] bool needs_attention() const noexcept {
    return success.verdict == SuccessVerdict::kOutOfRange || success.verdict == SuccessVerdict::kNotShown;
  }
};

/// Judges each training among the results by success_report(). The target is that of the prescription, else
/// of the exercise in assets/exercises, else the default of Difficulty.
/// @param results  by date
/// @returns the reports by exercise
/// @throws SceneError if assets/exercises is not found
[[nodiscard]] std::vector<TrainingReport> training_reports(const Patient& patient,
                                                           std::span<const ResultRow> results);

}  // namespace phalanx
