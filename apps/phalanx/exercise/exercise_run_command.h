// SPDX-License-Identifier: Apache-2.0
// `phalanx exercise run`: its options, the command, and the texts that it writes to the terminal.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "commands.h"
#include "patient/registry_options.h"
#include "phalanx/exercise/exercise_run.h"
#include "phalanx/record/recorded_exercise.h"
#include "run/run_options.h"

namespace phalanx {

/// Options of `phalanx exercise run` on its command line.
struct ExerciseOptions {
  std::string exercise;      ///< name or file
  std::string patient = {};  ///< code; empty: no patient
  std::string confirm = {};  ///< the code again, for scripts
  std::string demo = {};     ///< skill of a simulated participant; empty: a person
  std::optional<std::uint64_t> seed = {};
  bool record_plain = false;
  /// Largest stable stiffness, as the person who answers for the device states it [N/mm]
  std::optional<double> stable_n_per_mm = {};
  RegistryOptions registry = {};
  RunOptions run = {};  ///< device, calibration, recording
};

/// Adds `phalanx exercise run`.
void add_exercise_run(CLI::App& exercise, Job& job);

/// Carries out an exercise on a station, records it, makes its result from the recording, and adds that
/// to the registry.
/// @returns kDone; kFailed if the recording has no end, the replay differs, or the registry does not
/// take the result
/// @throws what refuses the exercise or the patient, with the remedy
[[nodiscard]] int run_exercise(const ExerciseOptions& options);

/// Formats the status: "trial 3/10  1.2 of 2.0 N  8 s  press and hold". Values that do not fit are left out.
/// @param width  largest number of columns
[[nodiscard]] std::string exercise_status(const ExerciseView& view, std::size_t width);

/// Formats one exercise of a recording: name, begin, how it ended, each score with its unit and origin or the
/// reason why there is none, and whether the replay gives the same bytes. Lines end with '\n'.
/// @param with_trials  also each trial's scores
[[nodiscard]] std::string exercise_report(const RecordedExercise& exercise, bool with_trials);

}  // namespace phalanx
