// SPDX-License-Identifier: Apache-2.0
// Reading and writing exercise files (TOML), and what an exercise does to a scene. docs/exercises.md has
// the table of keys.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "phalanx/exercise/exercise.h"
#include "phalanx/scene/scene.h"

namespace phalanx {

/// Version of the format; a file of another version is refused.
inline constexpr int kExerciseFormat = 1;

/// Loads an exercise by name in assets/exercises, or by path (contains `/` or ends with .toml).
/// @throws SceneError naming file, line, key, value and remedy: no such file, broken TOML, an unknown or
/// missing key, a number out of range, or a refusal of check_exercise(). Set-up only.
[[nodiscard]] ExerciseDescription load_exercise(const std::string& name_or_path);
/// Reads an exercise from text; `origin` names it in messages. The exercise's name is the file name of
/// `origin`, unless the text states `name`.
[[nodiscard]] ExerciseDescription parse_exercise(const std::string& text, const std::string& origin);
/// Writes an exercise so that parse_exercise() reads the same one, with every key that applies.
[[nodiscard]] std::string exercise_text(const ExerciseDescription& exercise);

/// Reads and writes a person's limits, for recordings. `origin` names the text in messages.
/// @throws SceneError as parse_exercise()
[[nodiscard]] PersonLimits parse_person_limits(const std::string& text, const std::string& origin);
[[nodiscard]] std::string person_limits_text(const PersonLimits& person);

/// Name and summary of an exercise file.
struct ExerciseInfo {
  std::string name;
  std::string title;  ///< if the file is not readable, the problem
  bool readable = true;
  ExerciseDescription exercise;  ///< if readable
};
/// @returns the exercises in assets/exercises, by name.
/// @throws SceneError if the folder is not found
[[nodiscard]] std::vector<ExerciseInfo> list_exercises();
/// @returns what load_exercise() refuses about a file, and why its scene cannot be used, a sentence
/// each; empty: nothing.
[[nodiscard]] std::vector<std::string> problems_of_exercise(const std::string& name_or_path);

/// One key of an exercise file.
struct ExerciseKey {
  std::string path;  ///< "dose.most_minutes"; "objects[].kind"
  std::string type;  ///< text, integer, number, pair, choice, list
  std::string unit;  ///< empty: none
  std::string range;
  std::string default_value;  ///< as written in a file; empty: none, or required
  std::string meaning;        ///< with the kinds or measures that have the key
};
/// @returns all keys, in the order of the documentation.
[[nodiscard]] const std::vector<ExerciseKey>& exercise_keys();
/// @returns all keys as the Markdown table of docs/exercises.md.
[[nodiscard]] std::string exercise_keys_markdown();

/// Applies an exercise and a person's limits to a scene: stiffness, fingertip force and joint torque
/// become the smallest of the scene's, the exercise's and the person's. A limit that is off is turned on.
/// Nothing else changes.
/// @returns the person's limits, lowered to those of the scene, with PersonLimits::detects_slips of the
/// scene's contacts: give these to ExerciseRun, so that its targets and stimuli stay within them
PersonLimits apply_exercise(SceneDescription& scene, const ExerciseDescription& exercise,
                            const PersonLimits& person);

/// @returns hash of the fixed conditions of an assessment, 16 hexadecimal digits: only results of equal ones
/// are compared. Empty for a training. It covers:
/// - the exercise without texts, dose and limits of ratings: they end a run, and an assessment that was cut
///   makes no trend
/// - `person`: digits that are felt, kind of calibration; if forces are sent, the largest force and stiffness.
///   It does not cover own force and own range, of which the targets are shares: they are results
/// - the scene's objects, contact and stabiliser; if forces are sent, its force law and limits
/// Not for cryptography: BitHash. Set-up only.
/// @param person  as apply_exercise() lowers it
/// @param values  of the scene with its overrides; the order has no effect
[[nodiscard]] std::string assessment_protocol(const ExerciseDescription& exercise, const PersonLimits& person,
                                              const Overrides& values);

/// @returns the overrides of the scene for one of ExerciseDescription::objects: kind and size of
/// its first object.
/// @pre 0 <= object < exercise.objects.size()
[[nodiscard]] Overrides object_overrides(const ExerciseDescription& exercise, int object);

}  // namespace phalanx
