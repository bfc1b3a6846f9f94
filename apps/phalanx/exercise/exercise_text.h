// SPDX-License-Identifier: Apache-2.0
// Texts of `phalanx exercise` on the terminal.
#pragma once

#include <cstddef>
#include <string>

#include "phalanx/exercise/exercise_run.h"
#include "phalanx/record/recorded_exercise.h"

namespace phalanx {

/// Formats the status: "trial 3/10  1.2 of 2.0 N  8 s  press and hold". Values that do not fit are left out.
/// @param width  largest number of columns
[[nodiscard]] std::string exercise_status(const ExerciseView& view, std::size_t width);

/// Formats one exercise of a recording: name, begin, how it ended, each score with its unit and origin or the
/// reason why there is none, and whether the replay gives the same bytes. Lines end with '\n'.
/// @param with_trials  also each trial's scores
[[nodiscard]] std::string exercise_report(const RecordedExercise& exercise, bool with_trials);

}  // namespace phalanx
