// SPDX-License-Identifier: Apache-2.0
// Whatever bytes an exercise file, a prescription or a person's limits hold, reading them ends in a description that is
// written and read back the same, or in an error with a message. The first byte chooses (p: a person's limits, r: a
// prescription of a shipped exercise, else: an exercise file).
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "phalanx/exercise/exercise.h"
#include "phalanx/exercise/training.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/scene/scene.h"

namespace {

using namespace phalanx;

void require(bool ok) {
  if (!ok) std::abort();
}

void judge(const ExerciseDescription& exercise) {
  require(exercise.trials >= 1 && std::isfinite(exercise.trial_s) && exercise.trial_s > 0.0);
  require(std::isfinite(exercise.rest_s) && exercise.rest_s >= 0.0);
  require(std::isfinite(exercise.target) && std::isfinite(exercise.tolerance));
  for (const auto& limit : {exercise.limits.force, exercise.limits.torque, exercise.limits.stiffness})
    require(!limit || (std::isfinite(*limit) && *limit > 0.0));
  const std::string text = exercise_text(exercise);
  require(exercise_text(parse_exercise(text, "again.toml")) == text);
}

void read_person(const std::string& text) {
  const PersonLimits person = parse_person_limits(text, "fuzz.toml");
  require(std::isfinite(person.force_cap) && person.force_cap >= 0.0);
  for (const auto& force : person.own_force) require(!force || (std::isfinite(*force) && *force >= 0.0));
  for (const auto& range : person.own_range)
    require(!range || (std::isfinite(range->min) && std::isfinite(range->max) && range->min <= range->max));
  const std::string again = person_limits_text(person);
  require(person_limits_text(parse_person_limits(again, "again.toml")) == again);
}

/// A prescription lowers limits; it raises none.
void read_prescription(const std::string& text) {
  static const ExerciseDescription shipped = load_exercise("train_press");
  const Prescription prescription = parse_prescription(text);
  if (prescription.exercise != shipped.name) return;
  const ExerciseDescription changed = prescribed(shipped, prescription);
  require(changed.dose.repetitions <= shipped.dose.repetitions &&
          changed.dose.minutes <= shipped.dose.minutes);
  judge(changed);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(data + 1, data + size);
  try {
    if (data[0] == 'p') {
      read_person(text);
    } else if (data[0] == 'r') {
      read_prescription(text);
    } else {
      judge(parse_exercise(text, "fuzz.toml"));
    }
  } catch (const SceneError& error) {
    require(error.what()[0] != '\0');
  } catch (const ExerciseError& error) {
    require(error.what()[0] != '\0');
  }
  return 0;
}
