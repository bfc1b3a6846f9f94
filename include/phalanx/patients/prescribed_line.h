// SPDX-License-Identifier: Apache-2.0
// Lines of a prescription: between the text that a person types and what the registry keeps.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/registry/patient.h"

namespace phalanx {

/// Reads a line such as "train_press trials=12 most_minutes=10" into what the registry keeps.
/// @throws ExerciseError as parse_prescription()
[[nodiscard]] PrescribedExercise prescribed_exercise_of_line(std::string_view line);

/// Writes a prescription as prescribed_exercise_of_line() reads it; its note is left out.
[[nodiscard]] std::string prescribed_exercise_line(const PrescribedExercise& prescribed);

/// Checks a prescription with the exercise of assets/exercises that has its name: it must not raise a dose or
/// a limit. Reads the disk.
/// @returns a remark in words if there is no such exercise, since the line then holds for a file of this
/// name; else empty
/// @throws ExerciseError naming the line, the key, the value and the remedy; SceneError if assets/exercises
/// is not found
[[nodiscard]] std::string check_prescribed(const PrescribedExercise& prescribed);

}  // namespace phalanx
