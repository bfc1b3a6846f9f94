// SPDX-License-Identifier: Apache-2.0
#include "phalanx/patients/prescribed_line.h"

#include <fmt/format.h>

#include <sstream>
#include <vector>

#include "phalanx/core/nearest_name.h"
#include "phalanx/exercise/exercise.h"
#include "phalanx/exercise/training.h"
#include "phalanx/scene/exercise_file.h"

namespace phalanx {

PrescribedExercise prescribed_exercise_of_line(std::string_view line) {
  const Prescription checked = parse_prescription(line);
  PrescribedExercise prescribed;
  prescribed.exercise = checked.exercise;
  prescribed.repetitions_per_day = checked.most_repetitions.value_or(0);
  prescribed.minutes_per_day = checked.most_minutes.value_or(0.0);
  Prescription rest = checked;
  rest.most_repetitions.reset();
  rest.most_minutes.reset();
  std::istringstream words(prescription_text(rest));
  std::string word;
  words >> word;  // the exercise
  while (words >> word) {
    const std::size_t at = word.find('=');
    if (at != std::string::npos) prescribed.overrides[word.substr(0, at)] = word.substr(at + 1);
  }
  return prescribed;
}

std::string prescribed_exercise_line(const PrescribedExercise& prescribed) {
  std::string line = prescribed.exercise;
  for (const auto& [key, value] : prescribed.overrides) line.append(fmt::format(" {}={}", key, value));
  if (prescribed.repetitions_per_day > 0)
    line.append(fmt::format(" most_repetitions={}", prescribed.repetitions_per_day));
  if (prescribed.minutes_per_day > 0.0)
    line.append(fmt::format(" most_minutes={}", prescribed.minutes_per_day));
  return line;
}

std::string check_prescribed(const PrescribedExercise& wanted) {
  const Prescription read = parse_prescription(prescribed_exercise_line(wanted));
  std::vector<std::string> names;
  for (const ExerciseInfo& info : list_exercises()) {
    names.push_back(info.name);
    if (info.name != wanted.exercise) continue;
    if (info.readable) static_cast<void>(prescribed(info.exercise, read));
    return {};
  }
  return fmt::format(
      "--prescribe {}: there is no such exercise in assets/exercises; {}the line holds for a file of this "
      "name",
      wanted.exercise, did_you_mean(wanted.exercise, names));
}

}  // namespace phalanx
