// SPDX-License-Identifier: Apache-2.0
// The fixed conditions of an assessment, as one hash.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>

#include "phalanx/core/bit_hash.h"
#include "phalanx/scene/exercise_file.h"

namespace phalanx {
namespace {

/// Adds the bytes of a text, and its length, so that two texts and their concatenation differ.
void add_text(std::string_view text, BitHash& hash) {
  constexpr std::size_t kWordBytes = 8;
  for (std::size_t at = 0; at < text.size(); at += kWordBytes) {
    std::uint64_t word = 0;
    for (const char c : text.substr(at, kWordBytes)) word = (word << 8U) | static_cast<unsigned char>(c);
    hash.add(word);
  }
  hash.add(static_cast<std::uint64_t>(text.size()));
}

/// @returns the exercise without what changes no trial
ExerciseDescription without_texts(ExerciseDescription exercise) {
  exercise.title.clear();
  exercise.title_de.clear();
  exercise.instruction.clear();
  for (ObjectChoice& object : exercise.objects) object.title.clear();
  exercise.scene = std::filesystem::path(exercise.scene).stem().string();  // its values have the content
  exercise.dose = {};
  exercise.ratings = {};
  exercise.limits = {};  // those in force are in the person's limits and the scene's values
  return exercise;
}

/// @returns the person's limits without own force, own range and the day's dose
PersonLimits of_device(const PersonLimits& person, const ExerciseDescription& exercise) {
  PersonLimits kept;
  kept.felt = person.felt;
  kept.calibration_independent = person.calibration_independent;
  kept.detects_slips = person.detects_slips;
  if (needs_torque(exercise.measure)) {
    kept.force_cap = person.force_cap;
    kept.stiffness_cap = person.stiffness_cap;
  }
  if (exercise.measure == ExerciseMeasure::kFeelAndFind) kept.stable_stiffness = person.stable_stiffness;
  return kept;
}

}  // namespace

std::string assessment_protocol(const ExerciseDescription& exercise, const PersonLimits& person,
                                const Overrides& values) {
  if (exercise.kind != ExerciseKind::kAssessment) return {};
  BitHash hash;
  add_text(exercise_text(without_texts(exercise)), hash);
  add_text(person_limits_text(of_device(person, exercise)), hash);
  const bool forces = needs_torque(exercise.measure);
  const std::map<std::string_view, std::string_view> sorted(values.begin(), values.end());
  for (const auto& [key, value] : sorted) {
    const bool of_objects =
        key.starts_with("objects") || key.starts_with("contact.") || key.starts_with("stabiliser.");
    const bool of_forces = key.starts_with("force.") || key.starts_with("limits.");
    if (!of_objects && !(forces && of_forces)) continue;
    add_text(key, hash);
    add_text(value, hash);
  }
  return fmt::format("{:016x}", hash.value());
}

}  // namespace phalanx
