// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "commands.h"
#include "exercise/exercise_options.h"

namespace phalanx {

/// Adds `phalanx exercise run`.
void add_exercise_run(CLI::App& exercise, Job& job);

/// Carries out an exercise on a station, records it, makes its result from the recording, and adds that
/// to the registry.
/// @returns kDone; kFailed if the recording has no end, the replay differs, or the registry does not
/// take the result
/// @throws what refuses the exercise or the patient, with the remedy
[[nodiscard]] int run_exercise(const ExerciseOptions& options);

}  // namespace phalanx
